#include "bindings/bindings.hpp"

namespace riffler {

void bind_tool(py::module_&) {}

}  // namespace riffler
