// The .rprog file: a program to the bit, with its tools and its provenance; versioned, checksummed, compressed.
//
//   header (40 bytes)  magic 8 | version u32 | tools u32 | length of the file u64 | rows u64 | notes u32 | CRC-32 of
//                      what is before it u32
//   record (20 bytes)  kind, 4 characters | number u32 | payload's length u64 | CRC-32 of the 16 bytes before and the
//                      payload u32 | payload
//
// All numbers are little-endian; a text is its length u32 and its bytes. One record "note": its number is that of the
// notes, the payload key and value of each, in order; what a reader noted is a key "note:LINE:KIND" among them, with
// the message. Then a record "tool" for every tool, by rising number: kind and name; the count u32 of parameters, and
// name and value f64 of each; the count of the profile's segments, and of each whether it has a centre (u32, 0 or 1),
// its end and, if so, its centre (2 or 4 × f64); shank and holder, each the count of pieces and 4 × f64 for each. Then
// a record "via " for every row with via poses, by rising row, which is its number: the count u32, and tip and axis of
// each (6 × f64). Then the rows, kChunkRows a record "rows" whose number is their count: columns (base/planes.hpp) of
// tip and axis x y z, feed and spindle (bits of doubles, u64), tool and line (u32), flags (u16): 1 for a rapid, 2 for a
// position of the machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// The file's bytes, and back: the same bytes for the same program, whatever the number of threads. `name` stands in
/// messages. FormatError names the byte at which a file is not what it should be (magic, version, checksum, a row that
/// Program::append refuses, truncated); nothing is allocated that the bytes at hand could not fill.
std::vector<std::uint8_t> to_bytes(const Program& program, const Progress& progress = {});
Program parse_program(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress = {});

/// Written beside and renamed, so a file is whole or not there.
void save_program(const Program& program, const std::filesystem::path& path, const Progress& progress = {});
Program load_program(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace riffler::nc
