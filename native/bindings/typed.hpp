// Python objects as arguments and results, with the type that a signature and the stub show for them.
//
// A binding that takes `const py::object&` is `typing.Any` in the stub. One that takes a Typed is what its tag says;
// pybind11 converts and checks neither, so the function does (to_vec3, to_progress …). Any object converts to a Typed,
// so a function may return one, too.
#pragma once

#include <pybind11/pybind11.h>

namespace riffler::bindings {

inline bool is_anything(PyObject*) {
  return true;
}

/// `Tag::name`: the annotation, made by pybind11::detail::const_name.
template <class Tag>
class Typed : public pybind11::object {
  PYBIND11_OBJECT(Typed, pybind11::object, is_anything)
};

}  // namespace riffler::bindings

template <class Tag>
struct pybind11::detail::handle_type_name<riffler::bindings::Typed<Tag>> {
  static constexpr auto name = Tag::name;
};

/// A type `Name` whose annotation is `text`.
#define RIFFLER_TYPED(Name, text)                                    \
  struct Name##Tag {                                                 \
    static constexpr auto name = pybind11::detail::const_name(text); \
  };                                                                 \
  using Name = Typed<Name##Tag>;

namespace riffler::bindings {

RIFFLER_TYPED(ArrayLike, "numpy.typing.ArrayLike")
RIFFLER_TYPED(OptionalArrayLike, "numpy.typing.ArrayLike | None")
RIFFLER_TYPED(ProgressLike, "collections.abc.Callable[[float], bool | None] | None")
/// Options of machines and posts.
RIFFLER_TYPED(OptionsLike, "collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None")

}  // namespace riffler::bindings
