#include "bindings/bindings.hpp"

namespace riffler {

void bind_journal(py::module_&) {}

}  // namespace riffler
