// Replayed journals give the bytes that they gave when hashes.txt was written. A change of the engine that is meant to
// change bits rewrites it with `make scenes`; the number of spans and the volume next to each hash show how much
// changed. Turning moves use the C library's sine and cosine, which may differ in the last bit between its versions.
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "scenes/scene.hpp"
#include "support/checkout.hpp"

namespace riffler::scenes::scenes_test {
namespace {

const std::filesystem::path kFolder = test::checkout() / "native/tests/scenes";

std::vector<std::string> lines() {
  std::ifstream file(kFolder / "hashes.txt");
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) out.push_back(line);
  return out;
}

TEST(Scenes, GiveTheSameBytesAsBefore) {
  const std::vector<std::string> expected = lines();
  ASSERT_FALSE(expected.empty());
  for (const std::string& line : expected) {
    const std::string name = line.substr(0, line.find(' '));
    EXPECT_EQ(describe(name, replay(kFolder / (name + ".rjournal"))), line);
  }
}

TEST(Scenes, AreAllListed) {
  std::set<std::string> listed, there;
  for (const std::string& line : lines()) listed.insert(line.substr(0, line.find(' ')));
  for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    if (entry.path().extension() == ".rjournal") there.insert(entry.path().stem());
  EXPECT_EQ(listed, there);
}

TEST(Scenes, HashesDifferForOneBit) {
  const dexel::Frame frame{{{0, 0, 0}, {4, 4, 4}}, 1, "xyz"};
  const Volume block = Volume::block(frame);
  EXPECT_EQ(hash(block), hash(Volume::block(frame)));
  Volume other = block;
  dexel::Grid& grid = other.grids()[2];
  auto tile = std::make_shared<dexel::Tile>(grid.tile(0));
  tile->spans[7].far = std::nextafter(4.0, 0);
  grid.set_tile(0, tile);
  EXPECT_NE(hash(block), hash(other));
}

}  // namespace
}  // namespace riffler::scenes::scenes_test
