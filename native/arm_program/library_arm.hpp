// Interface of a maker's library and of an arm that it drives.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pen/library/arm_state.hpp"

namespace riffler::arm_program {

enum class Reading { None, New, Gone };

/// An open arm. The destructor ends the force and closes the arm.
class LibraryArm {
 public:
  virtual ~LibraryArm() = default;
  virtual const pen::ArmTraits& traits() const = 0;
  /// Enables force, after a command of zero force. Throws OpenError.
  virtual void enable() = 0;
  /// s until a new reading is due.
  virtual double due() const noexcept = 0;
  /// Reads the arm's state without waiting.
  virtual Reading read(pen::ArmState& state) noexcept = 0;
  /// Sends a command. False if the arm has been unplugged.
  virtual bool push(const pen::ArmCommand& command) noexcept = 0;
};

class Library {
 public:
  virtual ~Library() = default;
  /// Keys of the arms that may have that name (empty: any arm).
  virtual std::vector<std::string> keys(const std::string& name) = 0;
  /// Opens an arm without force. Throws OpenError with the library's error text.
  virtual std::unique_ptr<LibraryArm> open(const std::string& key) = 0;
  /// Whether an opened arm has that name.
  virtual bool is(const pen::ArmTraits& traits, const std::string& name) const = 0;
  /// Message for a name that no arm has, or without any arm.
  virtual std::string none(const std::string& name) const = 0;
};

/// Load a library. Throw OpenError if the file is not that library.
std::unique_ptr<Library> load_dhd(const std::string& path);
std::unique_ptr<Library> load_hd(const std::string& path);

}  // namespace riffler::arm_program
