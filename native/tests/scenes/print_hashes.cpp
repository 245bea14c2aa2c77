// Prints what hashes.txt has to say about the journals of a folder: `make scenes`.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "scenes/scene.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: riffler_scene_hashes FOLDER\n"), 2;
  std::vector<std::filesystem::path> journals;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    if (entry.path().extension() == ".rjournal") journals.push_back(entry.path());
  std::sort(journals.begin(), journals.end());
  for (const auto& path : journals)
    std::puts(riffler::scenes::describe(path.stem().string(), riffler::scenes::replay(path)).c_str());
}
