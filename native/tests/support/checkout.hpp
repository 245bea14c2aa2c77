// Where the files of the checkout lie that tests read.
#pragma once

#include <filesystem>

namespace riffler::test {

std::filesystem::path checkout();

}  // namespace riffler::test
