// The .rprog file: a program, bit for bit, with its tools and provenance; versioned, checksummed, compressed.
//
//   header (40 bytes)  magic 8 | version u32 | tools u32 | length of the file u64 | rows u64 | notes u32 | CRC-32 of
//                      the bytes before u32
//   record (20 bytes)  kind, 4 characters | number u32 | length of the payload u64 | CRC-32 of the 16 bytes before and
//                      the payload u32 | payload
//
// All numbers are little-endian; a text is its length u32 and its bytes. The records, in order:
// - one "note"; number: count of notes; payload: key and value of each note, in order. A note of the NC reader has the
//   key "note:LINE:KIND" and its message as the value.
// - one "tool" per tool, in ascending order; number: tool number; payload: kind and name; the count u32 of parameters,
//   with name and value f64 of each; the count of profile segments, each with a flag u32 (1: it has a centre), its end
//   and, if flagged, its centre (2 or 4 × f64); shank and holder, each the count of pieces and 4 × f64 per piece.
// - one "via " per row with via poses, in ascending order; number: row; payload: count u32, then tip and axis of each
//   pose (6 × f64).
// - "rows", with at most kChunkRows rows each; number: count of rows; payload: columns (base/planes.hpp) of tip and
//   axis x y z, feed and spindle (bits of doubles, u64), tool and line (u32), flags (u16): 1 for a rapid, 2 for
//   at_machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// The bytes of the file, and the program from them. The same program gives the same bytes for any number of threads.
/// `name` identifies the file in messages. Throws FormatError naming the byte of the fault: magic, version, checksum, a
/// row that Program::append refuses, a truncated file. Never allocates more than the given bytes can fill.
std::vector<std::uint8_t> to_bytes(const Program& program, const Progress& progress = {});
Program parse_program(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress = {});

/// Writes the file atomically, under a temporary name that is then renamed, and reads it. Errors as parse_program;
/// std::runtime_error where the file cannot be written.
void save_program(const Program& program, const std::filesystem::path& path, const Progress& progress = {});
Program load_program(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace riffler::nc
