// Machines described in files: what they say, what is wrong with them, and where they are found.
#include "nc/machine/description.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "base/io.hpp"
#include "nc/machine/machines.hpp"
#include "nc/write/post.hpp"
#include "riffler/base/error.hpp"
#include "riffler/nc/write/writer.hpp"
#include "support/damaged.hpp"

namespace riffler::nc::description_test {
namespace {

constexpr const char* kMill = R"(description = "my mill"
words = "joints"
direction = "iso"
start = ["G53 G0 Z0"]

[axis.X]
limits = [-100, 100]
rate = 5000

[axis.A]
limits = [-30, 120]

[options]
table = [0, 0, 0]
raised = 5

[[rotary]]
letter = "C"
carries = "part"
axis = [0, 0, -2]
at = { table = [1, 1, 0], raised = [0, 0, 1] }

[[rotary]]
letter = "A"
carries = "part"
axis = [-1, 0, 0]
at = [0, 0, -50]
)";

MachineDescription describe(const std::string& toml, Options options = {}) {
  OptionReader reader(std::move(options), "machine mill");
  MachineDescription out = describe_machine(toml, "mill.toml", "mill", reader);
  take_post_options(reader);
  reader.done();
  return out;
}

TEST(Description, HasRetractsCoolantAndRequiredOptions) {
  const std::string more = "retract = [\"G91 G28 Z0\", \"G90\"]\ncoolant = \"mist\"\n" + std::string(kMill);
  const MachineDescription own = describe(more);
  EXPECT_EQ(own.control.retract, (std::vector<std::string>{"G91 G28 Z0", "G90"}));
  EXPECT_EQ(own.control.coolant, "mist");
  EXPECT_TRUE(describe(kMill).control.retract.empty());
  EXPECT_EQ(describe(kMill).control.coolant, "off");
  // A program by this file, with its coolant where its user says nothing.
  const auto file = std::filesystem::temp_directory_path() / "riffler_description_test.toml";
  {
    std::ofstream(file) << more;
  }
  Program p;
  p.append({{{1, 2, 3}, {0, 0, 1}}, 0, 1000, 1, 0, true});
  p.append({{{1, 2, 0}, {0, 0, 1}}, 100, 1000, 1, 0, false});
  WriteOptions how;
  how.post = file.string();
  const std::string text = to_nc(p, how);
  EXPECT_NE(text.find("\nG91 G28 Z0\nG90\nT1 M6\nS1000 M3\nM7\n"), text.npos) << text;
  EXPECT_NE(text.find("\nM9\n"), text.npos);
  EXPECT_TRUE(text.find("\nG91 G28 Z0\nG90\n", text.find("M9")) != text.npos) << text;
  how.options["coolant"] = std::string("off");
  EXPECT_EQ(to_nc(p, how).find("M7"), std::string::npos);
  std::filesystem::remove(file);
}

TEST(Description, AgreesWithItsFileAndOptions) {
  const MachineDescription own = describe(kMill);
  ASSERT_EQ(own.rotary.size(), 2U);
  EXPECT_FALSE(own.tip_words);
  EXPECT_EQ(own.rotary[0].direction, Vec3(0, 0, -1)) << "a unit vector";
  EXPECT_EQ(own.rotary[0].point, Vec3(0, 0, 5));
  EXPECT_EQ(own.rotary[1].point, Vec3(0, 0, -50));
  EXPECT_EQ(own.ranges[0].low, -100);
  EXPECT_EQ(own.ranges[0].rate, 5000);
  EXPECT_EQ(own.ranges[3].high, 120);
  EXPECT_EQ(own.ranges[3].rate, 3600) << "the default of tables whose words are joints";
  EXPECT_FALSE(own.ranges[5].limited());
  EXPECT_EQ(own.control.start, std::vector<std::string>{"G53 G0 Z0"});

  const MachineDescription given = describe(kMill, {{"table", std::vector<double>{1, 2, 3}},
                                                    {"raised", 7.0},
                                                    {"direction", std::string("linuxcnc")},
                                                    {"limits_c", std::vector<double>{-90, 90}},
                                                    {"rate_x", 100.0},
                                                    {"max_rotary", 200.0},
                                                    {"tcp", true}});
  EXPECT_EQ(given.rotary[0].direction, Vec3(0, 0, 1)) << "turned round";
  EXPECT_EQ(given.rotary[0].point, Vec3(1, 2, 7));
  EXPECT_EQ(given.ranges[5].low, -90);
  EXPECT_EQ(given.ranges[0].rate, 100);
  EXPECT_EQ(given.ranges[5].rate, 200);
  EXPECT_TRUE(given.tip_words);
}

std::string error(const std::string& toml, Options options = {}) {
  try {
    describe(toml, std::move(options));
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

/// The mill with one line for another.
std::string with(const std::string& line, const std::string& other) {
  std::string out = kMill;
  const std::size_t at = out.find(line);
  EXPECT_NE(at, out.npos) << line;
  return out.replace(at, line.size(), other);
}

TEST(Description, NamesTheLineThatIsWrong) {
  EXPECT_EQ(error(kMill), "");
  EXPECT_TRUE(error(with("\"iso\"", "iso")).starts_with("mill.toml, line 3: ")) << error(with("\"iso\"", "iso"));
  EXPECT_EQ(error(with("\"iso\"", "\"left\"")), "mill.toml, line 3: direction must be one of linuxcnc, iso");
  EXPECT_EQ(error(with("at = [0, 0, -50]", "a.\xC3\xA4 = 3")).substr(0, 19), "mill.toml, line 27:") << "no key";
  EXPECT_EQ(error(with("words", "word")), "mill.toml, line 2: unknown key word");
  EXPECT_EQ(error(with("description = \"my mill\"", "")), "mill.toml, line 1: description is missing");
  EXPECT_EQ(error(with("[-100, 100]", "[100, -100]")), "mill.toml, line 7: limits must be in increasing order");
  EXPECT_EQ(error(with("[-100, 100]", "[100]")), "mill.toml, line 7: limits must be two numbers");
  EXPECT_EQ(error(with("5000", "0")), "mill.toml, line 8: rate must be positive");
  EXPECT_EQ(error(with("5000", "nan")), "mill.toml, line 8: rate must be a finite number");
  EXPECT_EQ(error(with("axis.X", "axis.Q")), "mill.toml, line 6: axis must be tables [axis.X] of X Y Z A B C");
  EXPECT_EQ(error(with("letter = \"C\"", "letter = \"U\"")), "mill.toml, line 18: letter must be one of A, B, C");
  EXPECT_EQ(error(with("letter = \"C\"\n", "")), "mill.toml, line 17: letter is missing");
  EXPECT_EQ(error(with("\"part\"", "\"me\"")), "mill.toml, line 19: carries must be one of part, tool");
  EXPECT_EQ(error(with("[0, 0, -2]", "[0, 0, 0]")), "mill.toml, line 20: axis must not be zero");
  EXPECT_EQ(error(with("[0, 0, -2]", "[0, 0]")), "mill.toml, line 20: axis must be three finite numbers");
  EXPECT_EQ(error(with("{ table", "{ chair")), "mill.toml, line 21: at: there is no option chair");
  EXPECT_EQ(error(with("\"G53 G0 Z0\"", "\"G0\\nG1\"")),
            "mill.toml, line 4: start must be a list of texts in printable ASCII, one block each");
  EXPECT_EQ(error(with("raised = 5", "raised = { needed = \"joints\", numbers = 2, about = \"x\" }")),
            "mill.toml, line 15: numbers must be 1 or 3");
  EXPECT_EQ(error(with("start", "coolant = \"air\"\nstart")),
            "mill.toml, line 4: coolant must be one of off, flood, mist");
  EXPECT_EQ(error("description = \"x\"\ncontrol = \"siemens\""),
            "mill.toml, line 2: control must be one of rs274, heidenhain, sinumerik, apt");
  EXPECT_EQ(error(kMill, {{"pivot", 1.0}}).substr(0, 36), "machine mill: unknown option 'pivot'");
  EXPECT_TRUE(
      error(kMill, {{"raisd", 1.0}}).starts_with("machine mill: unknown option 'raisd'; did you mean raised? known: "));
  EXPECT_EQ(error(kMill, {{"limits_x", 1.0}}), "machine mill: option limits_x must be two finite ascending numbers");
}

TEST(Description, AnyDamageIsAMachineOrAnError) {
  std::mt19937 random(4);
  const std::string good = kMill;
  int machines = 0;
  for (int round = 0; round < 4000; ++round) {
    const std::string text = test::damaged(good, round, random);
    try {
      const Machine machine(describe(text));
      EXPECT_TRUE(geom::finite(machine.pose({1, 2, 3, 4, 5, 6}).axis));
      ++machines;
    } catch (const FormatError&) {
    } catch (const std::invalid_argument&) {
    }
  }
  EXPECT_GT(machines, 10);
}

TEST(Description, RequiresTheValuesThatJointsNeed) {
  OptionReader reader({{"tcp", false}}, "post head-head");
  try {
    make_machine("head-head", reader);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()),
              "post head-head: option pivot_length must be given: mm from the tip to the head's "
              "pivot, along the tool's axis");
  }
}

TEST(Description, TranslatesItsOwnTexts) {
  std::string file = kMill;
  file.replace(file.find("raised = 5"), 10, "raised = { value = 5, about = \"height\" }");
  const std::string german = "\n[translations.de]\ndescription = \"meine Fräse\"\n";
  const MachineTexts texts = machine_texts(
      file + german + "raised = { name = \"Höhe\", about = \"Höhe über dem Tisch\" }\ntable = { name = \"Tisch\" }",
      "mill.toml");
  EXPECT_EQ(texts.summary, "my mill");
  EXPECT_EQ(texts.language, "rs274");
  const std::map<std::string, std::string> expected{
      {"my mill", "meine Fräse"}, {"raised", "Höhe"}, {"height", "Höhe über dem Tisch"}, {"table", "Tisch"}};
  EXPECT_EQ(texts.translations.at("de"), expected);
  EXPECT_EQ(texts.translations.size(), 1u);
  EXPECT_TRUE(machine_texts(kMill, "mill.toml").translations.empty());
}

TEST(Description, NamesTheLineOfATranslationThatFitsNothing) {
  std::string file = kMill;
  file.replace(file.find("raised = 5"), 10, "raised = { value = 5, about = \"height\" }");
  const auto line = std::to_string(std::count(file.begin(), file.end(), '\n') + 2);
  const std::map<std::string, std::string> faults{
      {"risen = { name = \"Höhe\" }", "translations: there is no option risen"},
      {"raised = \"Höhe\"", "raised must be a table of name and about"},
      {"raised = { name = \"Höhe\" }", "about is missing"},
      {"raised = { name = \"Höhe\", unit = \"mm\" }", "unknown key unit"},
      {"description = 3", "description must be a text"}};
  for (const auto& [text, message] : faults) {
    try {
      describe(file + "[translations.de]\n" + text);
      FAIL() << text;
    } catch (const FormatError& e) {
      EXPECT_EQ(std::string(e.what()), "mill.toml, line " + line + ": " + message);
    }
  }
  EXPECT_THROW(describe(file + "[translations]\nde = 3"), FormatError);
}

TEST(Languages, EachHasItsOwnFileExtension) {
  std::set<std::string_view> all;
  for (const std::string_view language : kLanguages) {
    EXPECT_TRUE(file_extension(language).starts_with('.')) << language;
    EXPECT_TRUE(all.insert(file_extension(language)).second) << language;
  }
  EXPECT_EQ(file_extension("fanuc"), "");
}

TEST(Description, MayNotRedefineCommonOptions) {
  for (const std::string& name : std::vector<std::string>{"limits_a", "arcs", "safe_height", "feed"}) {
    std::string file = kMill;
    file.replace(file.find("raised = 5"), 6, name);
    file.replace(file.find("raised = [0"), 6, name);
    try {
      describe(file);
      FAIL() << name;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("option " + name + " would have two meanings"), std::string::npos)
          << e.what();
    }
  }
}

/// RIFFLER_MACHINES for the time of a test.
class OwnFolder {
 public:
  OwnFolder() {
    std::filesystem::create_directories(folder);
    setenv("RIFFLER_MACHINES", folder.c_str(), 1);
  }
  ~OwnFolder() {
    unsetenv("RIFFLER_MACHINES");
    std::filesystem::remove_all(folder);
  }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "riffler_own_machines";
};

TEST(Machines, OfTheUsersOwnAreFoundByNameAndByPath) {
  const OwnFolder own;
  base::write_file(own.folder / "mill.toml", std::string_view(kMill));
  base::write_file(own.folder / "broken.toml", std::string_view("description = 3"));
  base::write_file(own.folder / "tcp.toml", std::string_view(kMill));
  std::map<std::string, std::string> all;
  for (const base::DescriptionEntry& m : machines()) all[m.name] = m.description;
  EXPECT_EQ(all.at("mill"), "my mill");
  EXPECT_EQ(all.at("broken"), "cannot be read: broken.toml, line 1: description must be a text");
  EXPECT_TRUE(all.at("tcp").starts_with("five axes")) << "what comes with Riffler stays";
  EXPECT_TRUE(all.at("tcp.toml").starts_with("not used: "));
  for (const std::string& name : {std::string("mill"), (own.folder / "mill.toml").string()}) {
    OptionReader none({}, "machine");
    const auto machine = make_machine(name, none);
    EXPECT_EQ(machine->name(), "mill");
    EXPECT_EQ(machine->axes(), "XYZAC");
    EXPECT_EQ(machine->limited(), (std::vector<std::size_t>{0, 3}));
  }
}

}  // namespace
}  // namespace riffler::nc::description_test
