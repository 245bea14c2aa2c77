#include "bindings/verify_arguments.hpp"

#include <tuple>

#include "bindings/program_arguments.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "riffler/nc/read/reader.hpp"

namespace riffler::bindings {

namespace {

std::string fixture_name(std::size_t k) {
  return "fixtures, number " + std::to_string(k);
}

using Fixture = std::variant<Volume, std::shared_ptr<const Mesh>>;

std::vector<Fixture> to_fixtures(const FixturesLike& object) {
  std::vector<Fixture> out;
  if (object.is_none()) return out;
  if (py::isinstance<SharedVolume>(object) || py::isinstance<Mesh>(object))
    throw py::value_error("fixtures must be a list of Volume or Mesh, not one of them");
  for (const py::handle& item : py::cast<py::iterable>(object)) {
    if (py::isinstance<SharedVolume>(item))
      out.push_back(Reading(py::cast<SharedVolume&>(item)).volume.snapshot());
    else if (py::isinstance<Mesh>(item))
      out.push_back(py::cast<std::shared_ptr<Mesh>>(item));
    else
      throw py::value_error(fixture_name(out.size()) + ": a Volume or a Mesh expected");
  }
  return out;
}

/// Volumes unchanged; meshes as volumes at the stock's pitch.
std::vector<Volume> to_volumes(const std::vector<Fixture>& fixtures, double pitch, const Progress& progress) {
  std::vector<Volume> out;
  for (std::size_t k = 0; k < fixtures.size(); ++k) {
    if (const Volume* volume = std::get_if<Volume>(&fixtures[k])) {
      out.push_back(volume->snapshot());
      continue;
    }
    const Mesh& mesh = *std::get<std::shared_ptr<const Mesh>>(fixtures[k]);
    try {
      validate(mesh);
      const auto n = static_cast<double>(fixtures.size()), done = static_cast<double>(k);
      out.push_back(dexel::from_mesh(mesh, {bounds(mesh), pitch, "z"}, base::part(progress, done / n, (done + 1) / n)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fixture_name(k) + ": " + error.what());
    }
  }
  return out;
}

/// None where none is given, with nothing that belongs to one.
std::optional<verify::MachineChoice> to_machine(const GivenMachine& given) {
  if (!given.name) {
    if (!given.options.is_none()) throw py::value_error("machine_options: there is no machine");
    if (!given.frame.is_none()) throw py::value_error("machine_frame: there is no machine");
    return std::nullopt;
  }
  verify::MachineChoice machine{*given.name, nc::without_reading(to_options(given.options))};
  if (!given.frame.is_none()) std::tie(machine.turn, machine.shift) = to_affine(given.frame, "machine_frame");
  return machine;
}

}  // namespace

GivenArguments to_given(SharedVolume& stock, const std::shared_ptr<Mesh>& part, const FixturesLike& fixtures,
                        const ToolsLike& tools, verify::VerifyOptions options, const GivenMachine& machine) {
  options.machine = to_machine(machine);
  std::vector<Fixture> all = to_fixtures(fixtures);
  return {{Reading(stock).volume.snapshot(), part, {}, to_tools(tools, 0), std::move(options)}, std::move(all)};
}

verify::VerifyArguments to_arguments(const GivenArguments& given, const Progress& progress) {
  verify::VerifyArguments out = given.others;
  out.fixtures = to_volumes(given.fixtures, out.stock.frame().pitch, progress);
  return out;
}

}  // namespace riffler::bindings
