#include "engine/scene/mesh_files/polygon_file.hpp"

#include <fstream>

#include <fmt/format.h>

namespace tumble {

namespace {
constexpr uintmax_t most_bytes = uintmax_t{1} << 30;
}

std::string printable(std::string_view text, size_t longest_word) {
  std::string out;
  size_t word = 0;
  for (const char c : text) {
    word = c == ' ' ? 0 : word + 1;
    if (word == longest_word + 1) out += "...";
    if (word > longest_word) continue;
    const bool plain = c >= ' ' && c <= '~';
    out += plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return out;
}

Error mesh_file_fault(const std::filesystem::path& file, std::string message) {
  return {ErrorCode::parse, printable(message), file.string(),
          "write the file anew from the program that it comes from"};
}

Status check_mesh_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    return Error{ErrorCode::not_found, "there is no such file", file.string(), {}};
  }
  if (!std::filesystem::is_regular_file(file, error)) {
    return Error{ErrorCode::not_found, "this is not a file", file.string(), {}};
  }
  const uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return mesh_file_fault(file, "cannot be read: " + error.message());
  if (size == 0) return mesh_file_fault(file, "the file is empty");
  if (size > most_bytes) {
    return mesh_file_fault(
        file, fmt::format("the file has {} bytes; at most {} are read", size, most_bytes));
  }
  return {};
}

Result<std::string> read_mesh_bytes(const std::filesystem::path& file) {
  if (const Status ok = check_mesh_file(file); !ok) return ok.error();
  std::ifstream in(file, std::ios::binary);
  std::string bytes(size_t(std::filesystem::file_size(file)), '\0');
  in.read(bytes.data(), std::streamsize(bytes.size()));
  if (!in) return Error{ErrorCode::io, "the file cannot be read", file.string(), {}};
  return bytes;
}

}  // namespace tumble
