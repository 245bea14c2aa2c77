// Choosing one of several devices of a kind.
#include "pen/hid/hid_choice.hpp"

#include <gtest/gtest.h>

namespace riffler::pen::hid_choice_test {
namespace {

using Found = std::vector<std::size_t>;

HidInfo puck(const char* path, const char* name, const char* serial = "") {
  HidInfo info;
  info.path = path, info.name = name, info.serial = serial;
  return info;
}

TEST(HidChoice, TakesANumberThenASerialNumberThenAPartOfTheName) {
  const std::vector<HidInfo> all{puck("/dev/hidraw1", "SpaceMouse Compact", "2"),
                                 puck("/dev/hidraw4", "3Dconnexion Universal Receiver", "77"),
                                 puck("/dev/hidraw5", "3Dconnexion Universal Receiver", "A7")};
  EXPECT_EQ(chosen(all, "1"), Found{0});
  EXPECT_EQ(chosen(all, "2"), Found{1}) << "a number, though the first has that serial number";
  EXPECT_EQ(chosen(all, "77"), Found{1});
  EXPECT_EQ(chosen(all, "A7"), Found{2});
  EXPECT_EQ(chosen(all, "compact"), Found{0});
  EXPECT_EQ(chosen(all, "receiver"), (Found{1, 2}));
  EXPECT_EQ(chosen(all, ""), (Found{0, 1, 2}));
  for (const char* none : {"0", "4", "-1", "Compact 2", "99999999999999999999"}) EXPECT_TRUE(chosen(all, none).empty());
  EXPECT_TRUE(chosen({}, "1").empty());
}

TEST(HidChoice, EachIsListedWithItsNumber) {
  const std::vector<HidInfo> all{puck("/dev/hidraw1", "A", "2"), puck("/dev/hidraw4", "B")};
  EXPECT_EQ(numbered(all), "1: \"A\" at /dev/hidraw1, serial number 2; 2: \"B\" at /dev/hidraw4");
}

}  // namespace
}  // namespace riffler::pen::hid_choice_test
