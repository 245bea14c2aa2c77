#include "support/checkout.hpp"

std::filesystem::path riffler::test::checkout() {
  return RIFFLER_ROOT;
}
