// riffler.Volume: files and bytes.
#include "bindings/task.hpp"
#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/file/file.hpp"

namespace riffler::bindings {

namespace {

auto save_volume(SharedVolume& self, const std::filesystem::path& path, const ProgressLike& progress) {
  const auto work = [state = Reading(self).volume.snapshot(), path](const Progress& listener) {
    save(state, path, listener);
    return path;
  };
  return long_call(progress, work, [](const std::filesystem::path&) { return py::none(); });
}

std::shared_ptr<SharedVolume> load_volume(const std::filesystem::path& path, const ProgressLike& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  return share(dexel::load(path, listener));
}

auto volume_to_bytes(SharedVolume& self, const ProgressLike& progress) {
  const auto work = [state = Reading(self).volume.snapshot()](const Progress& listener) {
    return to_bytes(state, listener);
  };
  return long_call(progress, work, [](const std::vector<std::uint8_t>& bytes) {
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
}

std::shared_ptr<SharedVolume> volume_from_bytes(const py::buffer& data, const std::string& name) {
  const py::buffer_info info = data.request();
  const std::span bytes(static_cast<const std::uint8_t*>(info.ptr),
                        static_cast<std::size_t>(info.size * info.itemsize));
  const NoGil release;
  return share(dexel::from_bytes(bytes, name));
}

}  // namespace

void bind_volume_files(VolumeClass& volume) {
  volume
      .def("save", &save_volume, py::arg("path"), py::kw_only(), py::arg("progress") = py::none(),
           R"(Writes a .rvol file, whole or not at all. Equal volumes are equal files.

Parameters
----------
path : path_like
    The file; an existing one is replaced.
progress : callable or None
    Called with the finished share; returning False cancels.

Raises
------
RuntimeError
    The file cannot be written.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).save("block.rvol")
>>> riffler.Volume.load("block.rvol")
<riffler.Volume "z", pitch 0.5 mm, 8 × 6 rays>
)")
      .def_static("load", &load_volume, py::arg("path"), py::kw_only(), py::arg("progress") = py::none(),
                  R"(Reads a .rvol file.

Parameters
----------
path : path_like
    The file.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    A new volume.

Raises
------
FormatError
    The file is damaged or not a .rvol file. Names the byte.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).save("block.rvol")
>>> riffler.Volume.load("block.rvol").volume
24.0
)")
      .def("to_bytes", &volume_to_bytes, py::kw_only(), py::arg("progress") = py::none(),
           R"(The bytes of the .rvol file.

Parameters
----------
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
bytes
    The same for equal volumes.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> riffler.Volume.from_bytes(volume.to_bytes()).volume
24.0
)")
      .def_static("from_bytes", &volume_from_bytes, py::arg("data"), py::kw_only(), py::arg("name") = "volume",
                  R"(A volume from the bytes of `to_bytes`.

Parameters
----------
data : bytes, or another buffer
    Of a .rvol file.
name : str
    Name for messages.

Returns
-------
Volume
    A new volume.

Raises
------
FormatError
    The bytes are damaged.

Examples
--------
>>> data = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_bytes()
>>> riffler.Volume.from_bytes(data).volume
24.0
)")
      .def(py::pickle([](SharedVolume& v) { return py::bytes(volume_to_bytes(v, ProgressLike(py::none()))); },
                      [](const py::bytes& b) { return volume_from_bytes(py::buffer(b), "pickle"); }));
}

}  // namespace riffler::bindings
