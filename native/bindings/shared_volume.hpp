// A volume as Python holds it.
#pragma once

#include <mutex>
#include <shared_mutex>
#include <stdexcept>

#include "riffler/dexel/volume.hpp"

namespace riffler::bindings {

/// Long calls release the GIL, so another Python thread may come to the same volume: it gets a clear error, never a
/// torn volume, and never waits while it holds the GIL that the first thread's progress callback needs.
struct SharedVolume {
  explicit SharedVolume(Volume v) : volume(std::move(v)) {}
  Volume volume;
  dexel::Stats counted;  // with those that are still in `volume`: since the last take_counters
  std::shared_mutex mutex;
};

class Reading {
 public:
  explicit Reading(SharedVolume& v) : volume(v.volume), lock_(v.mutex, std::try_to_lock) {
    if (!lock_) throw std::runtime_error("the volume is being changed by another thread");
  }
  const Volume& volume;

 private:
  std::shared_lock<std::shared_mutex> lock_;
};

class Writing {
 public:
  explicit Writing(SharedVolume& v) : volume(v.volume), lock_(v.mutex, std::try_to_lock) {
    if (!lock_) throw std::runtime_error("the volume is in use by another thread");
  }
  Volume& volume;

 private:
  std::unique_lock<std::shared_mutex> lock_;
};

}  // namespace riffler::bindings
