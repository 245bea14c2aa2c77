// Reads JSON (RFC 8259) from front to back: strict, bounded, without allocating.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace riffler::pen {

/// A cursor in a JSON text. After the first error every function returns false and nothing more is read.
///
///   JsonReader json(text);
///   std::string_view key;
///   double x = 0;
///   if (json.object())
///     while (json.key(key)) key == "x" ? json.number(x) : json.skip();
///   const bool good = json.done();
class JsonReader {
 public:
  /// Containers within containers; a deeper text is an error.
  static constexpr std::size_t kDeepest = 32;

  /// The text must outlive the reader.
  explicit JsonReader(std::string_view text) : text_(text) {}

  /// Whether there was no error so far.
  bool ok() const { return ok_; }
  /// Whether the whole text was one value, without error.
  bool done();

  /// Enters an object.
  bool object();
  /// Moves to the next member and gives its name with its escapes; its value must be read or skipped before the next
  /// call. False at the end of the object, which it leaves.
  bool key(std::string_view& name);
  /// Enters an array.
  bool array();
  /// Moves to the next element, which must be read or skipped. False at the end of the array, which it leaves.
  bool element();

  // A value of another kind is an error.
  bool number(double& value);
  bool boolean(bool& value);
  /// A string with its escapes.
  bool string(std::string_view& value);
  /// Any value.
  bool skip();
  /// The first byte of the next value, which tells its kind; 0 at the end. No error.
  char peek();

 private:
  bool fail();
  bool take(char c);
  bool next(char close);
  bool word(std::string_view expected);
  void space();
  bool escape();

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  std::array<bool, kDeepest> begun_{};  // of each open container: a member or element was read
  bool ok_ = true;
};

}  // namespace riffler::pen
