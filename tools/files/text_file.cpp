// SPDX-License-Identifier: MIT
#include "tools/files/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/report/failure.hpp"

namespace delf {

TextFile::TextFile(const std::filesystem::path& path)
    : path_(path), file_(std::fopen(path.c_str(), "wb"), std::fclose) {
  if (!file_) fail();
}

TextFile::TextFile(const std::filesystem::path& path, const WrittenPart& kept)
    : path_(path), written_(kept), file_(std::fopen(path.c_str(), "r+b"), std::fclose) {
  if (!file_ || ftruncate(fileno(file_.get()), static_cast<off_t>(kept.size)) != 0 ||
      std::fseek(file_.get(), 0, SEEK_END) != 0)
    fail();
}

void TextFile::flush(bool sync) {
  if (std::fflush(file_.get()) != 0 || (sync && fsync(fileno(file_.get())) != 0)) fail();
}

void TextFile::write(std::string_view text) {
  written_.size += text.size();
  written_.sum.add(text);
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
}

void TextFile::close() {
  if (file_ && std::fclose(file_.release()) != 0) fail();
}

void TextFile::fail() const {
  throw SystemFailure(
      fmt::format("{}: {}; check that its disk has room and may be written to", path_.string(), std::strerror(errno)));
}

namespace {

bool is_dangling(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_symlink(path, error) && !std::filesystem::exists(path, error);
}

}  // namespace

void write_text_file(const std::filesystem::path& given, std::string_view text) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path path = given;
  if (const fs::file_status there = fs::status(given, error); fs::is_other(there) || is_dangling(given)) {
    TextFile file(given);  // a device, a pipe, or a link to what is not there yet
    file.write(text);
    file.close();
    return;
  }
  if (fs::is_symlink(given, error)) path = fs::canonical(given, error);
  if (error) path = given;
  const fs::path part = path.string() + ".part";
  try {
    TextFile file(part);
    file.write(text);
    file.close();
  } catch (...) {
    fs::remove(part, error);
    throw;
  }
  fs::rename(part, path, error);
  if (error) throw SystemFailure(fmt::format("{}: {}; choose another --out", path.string(), error.message()));
}

void make_results_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw SystemFailure(fmt::format("{}: cannot be made ({}); choose another --out", folder.string(),
                                    error ? error.message() : "it is no directory"));
}

}  // namespace delf
