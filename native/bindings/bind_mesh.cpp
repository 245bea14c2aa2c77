#include "bindings/bindings.hpp"

namespace riffler {

void bind_mesh(py::module_&) {}

}  // namespace riffler
