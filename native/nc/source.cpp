#include "nc/source.hpp"

#include <cstring>
#include <system_error>

#include "base/io.hpp"
#include "base/path_text.hpp"
#include "riffler/base/error.hpp"

namespace riffler::nc {

void NcPlace::fail(const std::string& what) const {
  constexpr std::size_t kShown = 80;
  std::string shown;
  for (const char c : text.substr(0, kShown)) shown += c >= ' ' && c <= '~' ? c : c == '\t' ? ' ' : '?';
  const std::size_t first = shown.find_first_not_of(' '), last = shown.find_last_not_of(' ');
  shown = first == shown.npos ? "" : shown.substr(first, last - first + 1);
  if (text.size() > kShown) shown += " ...";
  throw FormatError(file, "line " + std::to_string(line), what + (shown.empty() ? "" : " [" + shown + "]"));
}

NcSource::NcSource(const std::filesystem::path& path, std::size_t window) : name_(base::file_name(path)) {
  base::check_regular(path);
  file_ = base::open_input(path);
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown) size_ = static_cast<double>(size);
  buffer_.resize(window);
}

bool NcSource::more() {
  if (!file_) return false;
  const std::size_t kept = window_.size() - at_;
  if (kept == buffer_.size())
    throw FormatError(name_, "line " + std::to_string(line_ + 1),
                      "the line is longer than " + std::to_string(buffer_.size()) + " bytes");
  if (kept > 0) std::memmove(buffer_.data(), window_.data() + at_, kept);
  base_ += at_, at_ = 0;
  const std::size_t got = std::fread(buffer_.data() + kept, 1, buffer_.size() - kept, file_.get());
  if (std::ferror(file_.get()))
    throw FormatError(name_, "byte " + std::to_string(base_ + kept), "cannot be read further");
  window_ = {buffer_.data(), kept + got};
  return got > 0;
}

bool NcSource::next(std::string_view& line) {
  const void* end;
  while (!(end = at_ < window_.size() ? std::memchr(window_.data() + at_, '\n', window_.size() - at_) : nullptr)) {
    if (more()) continue;
    if (at_ == window_.size()) return false;
    end = window_.data() + window_.size();
    break;
  }
  line = window_.substr(at_, static_cast<std::size_t>(static_cast<const char*>(end) - window_.data()) - at_);
  at_ = std::min(at_ + line.size() + 1, window_.size());
  // Filler at the end of a line or file: CR LF and CR CR LF, CP/M's end of file, a paper tape's leader, UTF-8's byte
  // order mark.
  const auto is_filler = [](char c) { return c == '\r' || c == '\x1A' || c == '\0'; };
  while (!line.empty() && is_filler(line.back())) line.remove_suffix(1);
  while (!line.empty() && line.front() == '\0') line.remove_prefix(1);
  if (line_++ == 0 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  return true;
}

void NcSource::go(const Mark& mark) {
  line_ = mark.line;
  if (mark.offset >= base_ && mark.offset <= base_ + window_.size()) {
    at_ = static_cast<std::size_t>(mark.offset - base_);
    return;
  }
  if (!base::seek_input(file_.get(), mark.offset))
    throw FormatError(name_, "byte " + std::to_string(mark.offset), "cannot be read again: is it a pipe?");
  base_ = mark.offset, at_ = 0, window_ = {};
}

}  // namespace riffler::nc
