// Names of drafts: files that are to replace others.
#pragma once

#include <filesystem>

namespace riffler::base {

/// The path with its links resolved; their target need not exist. Throws std::runtime_error for a link that leads
/// nowhere.
std::filesystem::path followed(const std::filesystem::path& path);

std::filesystem::path folder_of(const std::filesystem::path& path);

/// A new name for a draft of `path`, of random letters after its draft_prefix (atomic_file.hpp).
std::filesystem::path random_draft(const std::filesystem::path& path);

}  // namespace riffler::base
