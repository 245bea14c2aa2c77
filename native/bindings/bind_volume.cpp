#include "bindings/bindings.hpp"

namespace riffler {

void bind_volume(py::module_&) {}

}  // namespace riffler
