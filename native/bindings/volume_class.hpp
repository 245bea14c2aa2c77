// riffler.Volume, which several files bind.
#pragma once

#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"

namespace riffler::bindings {

using VolumeClass = py::class_<SharedVolume, std::shared_ptr<SharedVolume>>;

inline std::shared_ptr<SharedVolume> share(Volume&& v) {
  return std::make_shared<SharedVolume>(std::move(v));
}

/// Methods that change a volume as a whole, or ask what it holds.
void bind_volume_edits(VolumeClass& volume);

}  // namespace riffler::bindings
