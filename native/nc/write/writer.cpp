#include "riffler/nc/write/writer.hpp"

#include <algorithm>

#include "base/io.hpp"
#include "nc/machine/header.hpp"
#include "nc/number_text.hpp"
#include "nc/write/row_check.hpp"

namespace riffler::nc {

namespace {

std::string describe(const Tool& tool) {
  std::string out = tool.kind();
  for (const auto& [name, value] : tool.parameters()) out += ", " + name + " " + number_text(value);
  return tool.name().empty() ? out : out + ", named " + tool.name();
}

std::vector<std::string> comments_on(const Program& program, const Machine& machine, const WriteOptions& options) {
  std::vector<std::string> out{header_line(machine), machine.meaning(),
                               "mm, degrees, feed in mm/min at the tip; tolerance " + number_text(options.tolerance) +
                                   " mm, axis " + number_text(options.axis_tolerance, 8) + " rad"};
  for (auto [key, value] : program.provenance) {
    // LinuxCNC executes comments such as "(LOGOPEN,": avoid the comma.
    std::replace(key.begin(), key.end(), ',', ' ');
    out.push_back(key + ": " + value);
  }
  for (const auto& [number, tool] : program.tools)
    out.emplace_back("T").append(std::to_string(number)).append(": ").append(describe(tool));
  return out;
}

}  // namespace

std::string to_nc(const Program& program, const WriteOptions& options, WriteReport* report) {
  for (const auto& [number, tool] : program.tools)
    tool.require_revolved("tool " + std::to_string(number) + ": an NC program");
  const RowCheck check(options);
  const std::unique_ptr<Post> post = check.make_post();
  WriteReport own;
  WriteReport& written = report ? *report : own;
  post->begin(comments_on(program, check.machine(), options));
  if (const auto fault = check.first_fault(program, *post, written)) throw RowError(*fault);
  post->end();
  written.blocks = post->blocks();
  return post->text();
}

WriteReport write_nc(const Program& program, const std::filesystem::path& path, const WriteOptions& options,
                     const std::function<void(const WriteReport&)>& check) {
  WriteReport report;
  const std::string text = to_nc(program, options, &report);
  if (check) check(report);
  base::write_file(path, text);
  return report;
}

}  // namespace riffler::nc
