// A file that is there only if all went well.
#pragma once

#include <filesystem>
#include <utility>

namespace meshless_cutting {

/// Removes the file at the end of the scope unless it was renamed to what it was for.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path path) : path_(std::move(path)) {}
  ~TemporaryFile() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Throws std::filesystem::filesystem_error when it cannot.
  void RenameTo(const std::filesystem::path& target) {
    std::filesystem::rename(path_, target);
    path_.clear();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace meshless_cutting
