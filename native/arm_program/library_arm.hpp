// A maker's library and an arm that it drives, as the program's loop uses them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pen/library/arm_state.hpp"

namespace riffler::arm_program {

enum class Reading { None, New, Gone };

/// An arm that is open. Its destructor ends the force and closes the arm.
class LibraryArm {
 public:
  virtual ~LibraryArm() = default;
  virtual const pen::ArmTraits& traits() const = 0;
  /// Lets commands push from now on, after one for zero force. Throws OpenError.
  virtual void enable() = 0;
  /// s until it is worth the while to read.
  virtual double due() const noexcept = 0;
  /// Never waits.
  virtual Reading read(pen::ArmState& state) noexcept = 0;
  /// False if the arm is gone.
  virtual bool push(const pen::ArmCommand& command) noexcept = 0;
};

class Library {
 public:
  virtual ~Library() = default;
  /// What it can try to open for that name (empty: any).
  virtual std::vector<std::string> keys(const std::string& name) = 0;
  /// Without force. Throws OpenError with the library's own words.
  virtual std::unique_ptr<LibraryArm> open(const std::string& key) = 0;
  /// Whether an arm that was opened is the one of that name.
  virtual bool is(const pen::ArmTraits& traits, const std::string& name) const = 0;
  /// Why nothing was found: no key, or none of that name.
  virtual std::string none(const std::string& name) const = 0;
};

/// Throw OpenError if the file is not that library.
std::unique_ptr<Library> load_dhd(const std::string& path);
std::unique_ptr<Library> load_hd(const std::string& path);

}  // namespace riffler::arm_program
