#include "pen/haply/haply_link.hpp"

#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/environment.hpp"
#include "pen/service/http.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr std::uint16_t kPort = 10001;
constexpr double kAnswer = 0.5;  // s for each step of the connection
constexpr const char* kPortVariable = "RIFFLER_HAPLY_PORT";

HaplyConnection connect(std::uint16_t port) {
  HaplyConnection out;
  try {
    out.version = read_haply_version(http_get(port, "/version", kAnswer));
  } catch (const std::invalid_argument& error) {
    throw OpenError(OpenProblem::BadContent, error.what());
  }
  out.socket = std::make_unique<WebSocket>(port, kAnswer);
  out.text.resize(WebSocket::kLongestMessage);
  const int n = out.socket->read(out.text, kAnswer);
  if (n <= 0) throw OpenError(OpenProblem::NoAnswer, "the service sends no list of devices");
  out.text.resize(static_cast<std::size_t>(n));
  if (!read_haply_message({reinterpret_cast<const char*>(out.text.data()), out.text.size()}, out.inventory))
    throw OpenError(OpenProblem::BadContent, "the service's list of devices makes no sense");
  return out;
}

}  // namespace

int HaplyLink::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  if (seconds >= kPeriod) {
    const auto due = written_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                    std::chrono::duration<double>(kPeriod));
    std::this_thread::sleep_until(due);
  }
  return socket_->read(bytes, seconds);
}

bool HaplyLink::write(std::span<const std::uint8_t> bytes) noexcept {
  written_ = std::chrono::steady_clock::now();
  return socket_->write(bytes);
}

std::uint16_t haply_port() {
  const std::string text = base::environment(kPortVariable).value_or("");
  if (text.empty()) return kPort;
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || end != text.data() + text.size() || port == 0)
    throw OpenError(OpenProblem::Other,
                    std::string(kPortVariable) + " must be a port, 1 to 65535, not \"" + text + "\"");
  return port;
}

HaplyConnection connect_haply(std::uint16_t port) {
  const std::string at = "127.0.0.1:" + std::to_string(port);
  try {
    return connect(port);
  } catch (const OpenError& error) {
    const std::string why = error.what();
    if (error.problem() == OpenProblem::NotRunning)
      throw OpenError(OpenProblem::NotRunning, at +
                                                   ": no program listens; start Haply Hub or the Inverse Service "
                                                   "(https://docs.haply.co/inverseSDK). If it listens elsewhere, set " +
                                                   kPortVariable);
    throw OpenError(error.problem(), why.starts_with(at) ? why : at + ": " + why);
  }
}

}  // namespace riffler::pen
