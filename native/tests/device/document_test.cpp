// What people read agrees with what the compiler reads: the tables of docs/device.md, the udev rule.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "device/fields.hpp"
#include "device/pens.hpp"
#include "support/checkout.hpp"

namespace riffler::device::document_test {
namespace {

using Row = std::vector<std::string>;

std::string text_of(const std::string& name) {
  std::ifstream file(test::checkout() / name);
  if (!file) throw std::runtime_error("cannot open " + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" `"), last = text.find_last_not_of(" `");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// The rows of the first table under each heading, its head left out.
std::map<std::string, std::vector<Row>> tables_of(const std::string& text) {
  std::map<std::string, std::vector<Row>> tables;
  std::istringstream lines(text);
  std::string heading;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ") || line.starts_with("### ")) heading = line.substr(line.find(' ') + 1);
    if (!line.starts_with("|")) continue;
    Row row;
    std::istringstream cells(line.substr(1));
    for (std::string cell; std::getline(cells, cell, '|');) row.push_back(trimmed(cell));
    tables[heading].push_back(row);
  }
  for (auto& [name, rows] : tables) rows.erase(rows.begin(), rows.begin() + 2);
  return tables;
}

const std::map<std::string, std::vector<Row>>& tables() {
  static const auto kTables = tables_of(text_of("docs/device.md"));
  return kTables;
}

TEST(PenDocument, HasEveryFieldOfEveryReport) {
  for (const Report& report : reports()) {
    const std::string heading =
        report.name + " report, number " + std::to_string(report.id) + ": " + std::to_string(report.size) + " bytes";
    ASSERT_TRUE(tables().contains(heading)) << heading;
    const std::vector<Row>& rows = tables().at(heading);
    ASSERT_EQ(rows.size(), report.fields.size()) << heading;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Field& field = report.fields[k];
      EXPECT_EQ(rows[k][0], std::to_string(field.offset)) << heading << ", " << field.name;
      EXPECT_EQ(rows[k][1], field.type + (field.count > 1 ? " × " + std::to_string(field.count) : "")) << field.name;
      EXPECT_EQ(rows[k][2], field.name) << heading;
    }
  }
}

TEST(PenDocument, HasTheReferenceLimits) {
  const Bytes bytes = encoded(reference().limits);
  const std::vector<Row>& rows = tables().at("Limits report, number 4: 54 bytes");
  const Report& report = reports()[3];
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t n = 0; n < report.fields[k].count; ++n) {
      const std::size_t width = report.fields[k].width();
      std::uint32_t value = 0;
      for (std::size_t b = 0; b < width; ++b)
        value |= std::uint32_t{bytes[report.fields[k].offset + n * width + b]} << (8 * b);
      EXPECT_EQ(rows[k][3], std::to_string(value)) << report.fields[k].name;
    }
}

TEST(PenDocument, HasEveryState) {
  std::string expected;
  for (unsigned state = 0; state < RIFFLER_PEN_STATES; ++state)
    expected += (state ? ", " : "") + std::to_string(state) + " " + riffler_pen_state_text(state);
  EXPECT_EQ(tables().at("Input report, number 1: 62 bytes")[0][3], expected);
}

TEST(PenDocument, HasEveryFlag) {
  const std::pair<const char*, int> flags[] = {
      {"HOST", RIFFLER_PEN_FLAG_HOST},         {"ARMED", RIFFLER_PEN_FLAG_ARMED},
      {"STALE", RIFFLER_PEN_FLAG_STALE},       {"LIMITED", RIFFLER_PEN_FLAG_LIMITED},
      {"FOLDBACK", RIFFLER_PEN_FLAG_FOLDBACK}, {"RATE_LIMITED", RIFFLER_PEN_FLAG_RATE_LIMITED},
      {"BRAKE", RIFFLER_PEN_FLAG_BRAKE}};
  const std::vector<Row>& rows = tables().at("Flags");
  ASSERT_EQ(rows.size(), std::size(flags));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k][1], flags[k].first);
    EXPECT_EQ(1 << std::stoi(rows[k][0]), flags[k].second) << rows[k][1];
  }
}

TEST(PenDocument, HasEveryFaultAndWhatItDoesToTheMotors) {
  const std::vector<Row>& rows = tables().at("Faults");
  ASSERT_EQ(rows.size(), std::size_t{RIFFLER_PEN_FAULTS} - 1);
  for (unsigned fault = 1; fault < RIFFLER_PEN_FAULTS; ++fault) {
    const Row& row = rows[fault - 1];
    EXPECT_EQ(row[0], std::to_string(fault));
    EXPECT_EQ(row[1], riffler_pen_fault_text(fault));
    Pen pen;
    pen.activate();
    pen.pen.state = RIFFLER_PEN_FAULT;
    pen.pen.fault = static_cast<std::uint8_t>(fault);
    EXPECT_EQ(pen.step().brake ? "brake" : "off", row[3]) << row[1];
  }
}

TEST(PenDocument, HasEveryTransition) {
  const std::map<std::string, unsigned> events = {{"fault", RIFFLER_PEN_ON_FAULT},
                                                  {"ready", RIFFLER_PEN_ON_READY},
                                                  {"disable", RIFFLER_PEN_ON_DISABLE},
                                                  {"enable", RIFFLER_PEN_ON_ENABLE},
                                                  {"full", RIFFLER_PEN_ON_FULL}};
  ASSERT_EQ(events.size(), std::size_t{RIFFLER_PEN_EVENTS});
  const std::vector<Row>& rows = tables().at("States");
  for (unsigned state = 0; state < RIFFLER_PEN_STATES; ++state)
    for (const auto& [event, bit] : events) {
      std::string expected = riffler_pen_state_text(state);
      for (const Row& row : rows)
        if ((row[0] == "any" || row[0] == riffler_pen_state_text(state)) && row[2] == event) expected = row[1];
      EXPECT_EQ(riffler_pen_state_text(riffler_pen_next_state(static_cast<riffler_pen_state>(state), bit)), expected)
          << "in " << riffler_pen_state_text(state) << " on " << event;
    }
}

TEST(PenDocument, HasTheNumbersThatUsbReports) {
  const std::string text = text_of("docs/device.md");
  EXPECT_NE(text.find("`riffler_pen_descriptor`, " + std::to_string(riffler_pen_descriptor_size) + " bytes"),
            std::string::npos);
  EXPECT_EQ(tables().at("USB")[1][1], "1209:0001");
  EXPECT_EQ(tables().at("USB")[2][1], RIFFLER_PEN_PRODUCT);
}

std::string hex4(int number) {
  char text[8];
  std::snprintf(text, sizeof text, "%04x", static_cast<unsigned>(number));
  return text;
}

TEST(PenUdevRule, IsForThePenAndGrantsAccessToTheSeatedUser) {
  std::filesystem::path rule;
  for (const auto& entry : std::filesystem::directory_iterator(test::checkout() / "device/udev")) {
    EXPECT_TRUE(rule.empty()) << "one file";
    rule = entry.path();
  }
  EXPECT_EQ(rule.extension(), ".rules") << "udev reads no others";
  EXPECT_LT(rule.filename().string(), "73-seat-late.rules") << "which acts on the tag";
  std::istringstream lines(text_of("device/udev/" + rule.filename().string()));
  int rules = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    ++rules;
    std::map<std::string, std::string> matches, assignments;
    // key, operator, value, comma: anything else on the line is a mistake that udev would only log.
    static const std::regex kTerm(R"re(\s*([A-Z]+(?:\{\w+\})?)\s*(==|!=|\+=|=)\s*"([^"]*)"\s*(,|$))re");
    std::string rest = line;
    for (std::smatch term; std::regex_search(rest, term, kTerm, std::regex_constants::match_continuous);) {
      (term[2] == "==" ? matches : assignments)[term[1]] = term[3];
      rest = term.suffix();
    }
    EXPECT_EQ(rest, "") << "what udev would not understand";
    EXPECT_EQ(matches["SUBSYSTEM"], "hidraw");
    EXPECT_EQ(matches["ATTRS{idVendor}"], hex4(RIFFLER_PEN_VENDOR_ID)) << "lower case, as sysfs has it";
    EXPECT_EQ(matches["ATTRS{idProduct}"], hex4(RIFFLER_PEN_PRODUCT_ID));
    EXPECT_EQ(matches["ATTRS{product}"], RIFFLER_PEN_PRODUCT) << "the numbers are everybody's";
    EXPECT_EQ(assignments["TAG"], "uaccess");
    EXPECT_FALSE(assignments.contains("MODE") || assignments.contains("GROUP"));
  }
  EXPECT_EQ(rules, 1);
}

}  // namespace
}  // namespace riffler::device::document_test
