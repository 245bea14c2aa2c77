// NC code read from texts in tests.
#pragma once

#include <string>

#include "riffler/base/error.hpp"
#include "riffler/nc/read/reader.hpp"

namespace riffler::test {

inline nc::Program read_nc_text(const std::string& text, const std::string& machine = "tcp", nc::Options options = {}) {
  return nc::parse_nc(text, "p.ngc", {machine, std::move(options)});
}

/// What the FormatError says, after the file's name.
inline std::string nc_error(const std::string& text, const std::string& machine = "tcp", nc::Options options = {}) {
  try {
    read_nc_text(text, machine, std::move(options));
  } catch (const FormatError& e) {
    const std::string what = e.what();
    return what.substr(what.find(", ") + 2);
  }
  return "no error";
}

/// The only tip's x of a program that is one rapid of X.
inline double nc_x(const std::string& value, const std::string& before = "") {
  return read_nc_text(before + "\nG0 X" + value).poses().back().tip.x;
}

}  // namespace riffler::test
