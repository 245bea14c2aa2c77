#include "bindings/lost.hpp"

#include <cstdio>
#include <stdexcept>

namespace riffler::bindings {

namespace {

template <class... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char out[400];
  std::snprintf(out, sizeof out, text, numbers...);
  return out;
}

/// "… between (0, 0, 0) and (50, 50, 0.3); a pitch of 0.29 mm keeps it"
std::string where(const Lost& lost) {
  const Vec3 &a = lost.box.lower, &b = lost.box.upper;
  std::string text = format("between (%.6g, %.6g, %.6g) and (%.6g, %.6g, %.6g)", a.x, a.y, a.z, b.x, b.y, b.z);
  if (lost.pitch > 0) text += format("; a pitch of %.3g mm keeps it", lost.pitch);
  return text;
}

Lost thin_in(const Volume& volume) {
  Lost out;
  out.of = volume.volume(), out.used = volume.frame().pitch;
  marching::ThinMaterial thin;
  try {
    thin = marching::thin_material(volume);
  } catch (const std::invalid_argument&) {
    return out;  // too far from the origin for a mesh, which to_mesh says
  }
  out.volume = thin.volume, out.pitch = thin.pitch, out.box = thin.box;
  if (thin.notable)
    out.note = format("%.6g mm³ of material (of %.6g) is thinner than the pitch of %.6g mm and no part of the mesh: ",
                      out.volume, std::max(out.of, out.volume), out.used) +
               where(out);
  return out;
}

py::tuple corner(const Vec3& p) {
  return py::make_tuple(p.x, p.y, p.z);
}

}  // namespace

Lost lost_in(const Volume& volume, const dexel::MissedMaterial& missed) {
  Lost out = thin_in(volume);
  if (!(missed.volume > out.volume)) return out;
  out.volume = missed.volume, out.pitch = missed.pitch, out.box = missed.box;
  out.note =
      format("the rays miss %.6g mm³ of the mesh, which is thinner than the pitch of %.6g mm: ", out.volume, out.used) +
      where(out);
  return out;
}

Lost lost_by_meshing(const Volume& volume, std::size_t triangles) {
  Lost out = thin_in(volume);
  if (triangles > 0 || !(out.of > 0)) return out;
  // Crumbs of less than a pitch all around may lie next to each other.
  out.volume = std::max(out.volume, out.of);
  if (out.box.empty()) out.box = volume.frame().box;
  out.note = format("nothing of the %.6g mm³ of material is thick enough for a mesh at the pitch of %.6g mm: ", out.of,
                    out.used) +
             where(out);
  return out;
}

void warn(const Lost& lost) {
  if (!lost.note.empty() && PyErr_WarnEx(PyExc_UserWarning, lost.note.c_str(), 2) != 0) throw py::error_already_set();
}

void put(const Lost& lost, py::dict& fields) {
  fields["lost"] = lost.volume, fields["lost_note"] = lost.note;
  fields["lost_pitch"] = lost.volume > 0 && lost.pitch > 0 ? py::object(py::float_(lost.pitch)) : py::none();
  fields["lost_box"] = py::none();
  if (lost.volume > 0 && !lost.box.empty())
    fields["lost_box"] = py::make_tuple(corner(lost.box.lower), corner(lost.box.upper));
}

}  // namespace riffler::bindings
