#include "io/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "base/error.hpp"

namespace eg {

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

std::string reason() { return std::strerror(errno); }

}  // namespace

std::string read_file(const std::string& path) {
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored))
    throw input_error(path, 0, "is a folder,", "not a file", "name a file in it");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw input_error(path, 0, "cannot be opened", "(" + reason() + ")", "check the path");
  std::string bytes;
  char block[1 << 16];
  while (const std::size_t n = std::fread(block, 1, sizeof block, file.get())) bytes.append(block, n);
  if (std::ferror(file.get())) throw input_error(path, 0, "cannot be read", "(" + reason() + ")");
  return bytes;
}

void replace_file(const std::string& path, const std::function<void(const std::string&)>& write) {
  const std::string temporary = path + ".part";
  std::error_code failure;
  try {
    write(temporary);
  } catch (...) {
    std::filesystem::remove(temporary, failure);
    throw;
  }
  std::filesystem::rename(temporary, path, failure);
  if (failure) throw RunError(path + ": cannot be written (" + failure.message() + ")");
}

void write_file(const std::string& path, std::string_view bytes) {
  replace_file(path, [&](const std::string& temporary) {
    File file(std::fopen(temporary.c_str(), "wb"));
    const bool written = file && std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    if (!written || std::fclose(file.release()) != 0)
      throw RunError(path + ": cannot be written (" + reason() + "); check that the folder exists and has room");
  });
}

}  // namespace eg
