#include "engine/scene/pack/pack.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <minizip/unzip.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t free_bytes = 16 << 20;  // size for which no ratio is checked

struct CloseArchive {
  void operator()(void* archive) const { unzClose(archive); }
};
using Archive = std::unique_ptr<void, CloseArchive>;

Error refuse(const fs::path& file, const std::string& entry, std::string why, std::string cure) {
  const std::string place = entry.empty() ? file.string() : file.string() + ": " + entry;
  return {ErrorCode::parse, std::move(why), place, std::move(cure)};
}

Error broken(const fs::path& file, const std::string& entry) {
  return refuse(file, entry, "the archive is damaged, or ends early",
                "get the file anew, or pack the scene again");
}

/// Why a name is not a plain relative path below a folder; "" if it is.
std::string bad_name(const std::string& name) {
  if (name.empty() || name.size() > 400) return "its name is empty or too long";
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == ':' || c == 0x7f)
      return "its name holds a sign that paths must not have";
  if (name.front() == '/') return "its name is an absolute path";
  size_t begin = 0;
  while (begin <= name.size()) {
    const size_t end = std::min(name.find('/', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    const bool folder_end = end == name.size() && begin > 0 && part.empty();
    if (part == ".." || part == "." || (part.empty() && !folder_end))
      return "its name leads out of the folder";
    begin = end + 1;
  }
  return {};
}

/// Whether an entry is a link, a device or a pipe; archives written on systems other than Unix have
/// no such type.
bool is_special(const unz_file_info64& info) {
  constexpr uLong type_mask = 0170000, regular = 0100000, folder = 0040000;
  const uLong type = info.external_fa >> 16 & type_mask;
  return info.version >> 8 == 3 && type != 0 && type != regular && type != folder;
}

class PackReader {
 public:
  PackReader(const fs::path& file, const PackLimits& limits) : file_(file), limits_(limits) {
    std::error_code none;
    packed_ = fs::file_size(file, none);
  }

  Result<std::vector<PackFile>> run() {
    archive_.reset(unzOpen64(file_.c_str()));
    unz_global_info64 all{};
    if (!archive_ || unzGetGlobalInfo64(archive_.get(), &all) != UNZ_OK) return broken(file_, {});
    if (all.number_entry == 0) return broken(file_, {});
    if (all.number_entry > limits_.entries)
      return refuse(file_, {},
                    fmt::format("has {} entries, more than {}", all.number_entry, limits_.entries),
                    "pack one scene only");
    for (uint64_t i = 0; i < all.number_entry; ++i) {
      const int at = i == 0 ? unzGoToFirstFile(archive_.get()) : unzGoToNextFile(archive_.get());
      if (at != UNZ_OK) return broken(file_, {});
      if (Status s = entry(); !s) return s.error();
    }
    return std::move(out_);
  }

 private:
  Status entry() {
    unz_file_info64 info{};
    std::string name(512, '\0');
    if (unzGetCurrentFileInfo64(archive_.get(), &info, name.data(), name.size(), nullptr, 0,
                                nullptr, 0) != UNZ_OK)
      return broken(file_, {});
    name.resize(std::min<size_t>(info.size_filename, name.size()));
    const auto no = [&](std::string why, std::string cure) -> Status {
      return refuse(file_, shown(name), std::move(why), std::move(cure));
    };
    if (const std::string why = bad_name(name); !why.empty())
      return no(why, "do not open this file: it was not made by `tumble pack`");
    if (is_special(info)) return no("it is a link, not a file", "pack the file that it leads to");
    if (info.flag & 1) return no("it is encrypted", "pack the scene without a password");
    if (info.compression_method != 0 && info.compression_method != 8)
      return no(fmt::format("it is compressed by method {}", info.compression_method),
                "pack the scene by `tumble pack`, or by zip with its usual method");
    if (name.back() == '/') return {};
    if (!names_.insert(name).second) return no("the archive has two of this name", "leave one");
    return read(name, info.uncompressed_size);
  }

  Status read(const std::string& name, uint64_t claimed) {
    const auto bomb = [&]() -> Status {
      return refuse(file_, shown(name),
                    fmt::format("the archive of {} bytes would become more than {} bytes", packed_,
                                allowed()),
                    "do not open this file: scenes do not compress so well");
    };
    if (claimed > allowed() || total_ + claimed > allowed()) return bomb();
    if (unzOpenCurrentFile(archive_.get()) != UNZ_OK) return broken(file_, shown(name));
    PackFile& out = out_.emplace_back();
    out.name = name;
    char buffer[1 << 16];
    int got = 0;
    while ((got = unzReadCurrentFile(archive_.get(), buffer, sizeof buffer)) > 0) {
      total_ += uint64_t(got);
      if (total_ > allowed()) return bomb();
      out.bytes.append(buffer, size_t(got));
    }
    // Closing reports whether the checksum matches.
    if (unzCloseCurrentFile(archive_.get()) != UNZ_OK || got < 0 || out.bytes.size() != claimed)
      return broken(file_, shown(name));
    return {};
  }

  uint64_t allowed() const {
    return std::min(limits_.bytes, std::max(free_bytes, packed_ * limits_.ratio));
  }
  static std::string shown(std::string name) {
    for (char& c : name)
      if (static_cast<unsigned char>(c) < 0x20) c = '?';
    return name.substr(0, 100);
  }

  fs::path file_;
  PackLimits limits_;
  Archive archive_;
  uint64_t packed_ = 0, total_ = 0;
  std::set<std::string> names_;
  std::vector<PackFile> out_;
};

}  // namespace

bool is_pack_file(const fs::path& file) {
  char head[4] = {};
  std::ifstream in(file, std::ios::binary);
  if (!in.read(head, 4)) return false;
  return head[0] == 'P' && head[1] == 'K' &&
         ((head[2] == 3 && head[3] == 4) || (head[2] == 5 && head[3] == 6));
}

Result<std::vector<PackFile>> read_pack(const fs::path& file, const PackLimits& limits) {
  return PackReader(file, limits).run();
}

}  // namespace tumble
