#include "bindings/bindings.hpp"

namespace riffler {

void bind_program(py::module_&) {}

}  // namespace riffler
