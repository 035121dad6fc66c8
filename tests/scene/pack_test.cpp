// Packs: what goes in comes out, and hostile archives are refused. References: the scene before it
// was packed (text and state hash), and archives written by hand after the format's specification
// (PKWARE APPNOTE), stored without compression.
#include "engine/scene/pack/pack.hpp"

#include "engine/scene/build.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

using namespace tumble;

namespace {

const std::string scene_text = R"({"tumble_scene": 1, "bodies": {}})";

/// CRC-32, bit by bit.
uint32_t crc(const std::string& bytes) {
  uint32_t sum = 0xffffffffu;
  for (const char c : bytes) {
    sum ^= uint8_t(c);
    for (int k = 0; k < 8; ++k) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320u : 0);
  }
  return ~sum;
}

struct Entry {
  std::string name, bytes;
  uint32_t attributes = 0100644u << 16;
  uint16_t flags = 0, method = 0;
  std::optional<uint32_t> claimed = {};  ///< bytes, in place of the truth
};

void put_number(std::string& out, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += char(value >> 8 * i);
}

/// The fields that local and central headers share.
std::string common(const Entry& e) {
  std::string out;
  put_number(out, 20, 2);
  put_number(out, e.flags, 2);
  put_number(out, e.method, 2);
  put_number(out, 0x21, 4);  // time, date
  put_number(out, crc(e.bytes), 4);
  put_number(out, e.bytes.size(), 4);
  put_number(out, e.claimed.value_or(uint32_t(e.bytes.size())), 4);
  put_number(out, e.name.size(), 2);
  put_number(out, 0, 2);
  return out;
}

std::string archive(const std::vector<Entry>& entries) {
  std::string out, central;
  for (const Entry& e : entries) {
    const size_t offset = out.size();
    out += "PK\3\4" + common(e) + e.name + e.bytes;
    central += std::string("PK\1\2");
    put_number(central, 3 << 8 | 20, 2);  // made by Unix
    central += common(e);
    put_number(central, 0, 6);  // comment, disk, internal attributes
    put_number(central, e.attributes, 4);
    put_number(central, offset, 4);
    central += e.name;
  }
  const size_t begin = out.size();
  out += central + "PK\5\6";
  put_number(out, 0, 4);
  put_number(out, entries.size(), 2);
  put_number(out, entries.size(), 2);
  put_number(out, central.size(), 4);
  put_number(out, begin, 4);
  put_number(out, 0, 2);
  return out;
}

struct PackRig {
  TempFolder folder;
  std::filesystem::path file = folder / "a.tumble";
  PackRig() { setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1); }
  ~PackRig() { unsetenv("XDG_CACHE_HOME"); }
  void write(const std::string& bytes) const {
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  }
  /// Refused with these words, and with a cure; nothing was left.
  void refuses(const std::vector<Entry>& entries, const std::string& words) const {
    write(archive(entries));
    refuses(words);
  }
  void refuses(const std::string& words) const {
    const auto got = unpack(file);
    REQUIRE_FALSE(got.ok());
    const std::string text = got.error().text();
    CHECK_MESSAGE(text.find(words) != std::string::npos, text);
    CHECK(text.find("a.tumble") != std::string::npos);
    CHECK_FALSE(got.error().cure.empty());
    CHECK_FALSE(std::filesystem::exists(folder / "cache"));
    CHECK_FALSE(std::filesystem::exists(folder / "evil.json"));
  }
};

uint64_t hash_of(const std::string& scene) {
  const SceneRead read = open_scene(scene);
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  WorldDef extras;
  extras.threads = 1;
  const auto built = build_world(read.scene, extras);
  REQUIRE(built.ok());
  return built->world->state_hash();
}

}  // namespace

TEST_CASE("a packed scene is the same scene, with its meshes, on a machine that has none") {
  const PackRig rig;
  for (const char* scene : {"hello", "cups_and_rings", "lesson_12_distance_fields"}) {
    CAPTURE(scene);
    const auto files = pack_files(scene);
    REQUIRE(files.ok());
    CHECK((*files)[0].name == std::string(scene) + ".json");
    const std::string before = file_text(resolve_scene(scene)->string());
    // Line by line as it was, but for paths of meshes.
    CHECK(std::count(before.begin(), before.end(), '\n') ==
          std::count((*files)[0].bytes.begin(), (*files)[0].bytes.end(), '\n'));
    if (files->size() == 1) CHECK((*files)[0].bytes == before);
    REQUIRE(write_pack(rig.file, *files));
    CHECK(is_pack_file(rig.file));
    const auto back = read_pack(rig.file);
    REQUIRE_MESSAGE(back.ok(), test::why_not(back));
    REQUIRE(back->size() == files->size());
    for (size_t i = 0; i < files->size(); ++i) {
      CHECK((*back)[i].name == (*files)[i].name);
      CHECK((*back)[i].bytes == (*files)[i].bytes);
      if (i > 0) CHECK((*back)[i].name.starts_with("meshes/"));
    }
    if (!test::only_to_run()) CHECK(hash_of(rig.file.string()) == hash_of(scene));
    const std::string bytes = file_text(rig.file.string());
    REQUIRE(write_pack(rig.file, *files));
    CHECK(file_text(rig.file.string()) == bytes);
  }
}

TEST_CASE("robots and bare meshes are packed as the scenes about them") {
  const PackRig rig;
  for (const char* scene : {"robot_arm", "assets/meshes/gear.obj"}) {
    const std::string name = std::string(scene).find('/') == std::string::npos
                                 ? scene
                                 : std::string(TUMBLE_SOURCE_DIR) + "/" + scene;
    const auto files = pack_files(name);
    REQUIRE_MESSAGE(files.ok(), test::why_not(files));
    REQUIRE(write_pack(rig.file, *files));
    CHECK(hash_of(rig.file.string()) == hash_of(name));
  }
}

TEST_CASE("a mesh file takes no files along that are not in its folder") {
  const PackRig rig;
  std::filesystem::create_directories(rig.folder / "scene");
  const auto put = [&](const char* name, const std::string& text) {
    std::ofstream(rig.folder / name, std::ios::binary) << text;
  };
  put("private.bin", "nobody's business");
  put("scene/a.json", R"({"tumble_scene": 1, "meshes": {"m": {"file": "m.gltf"}}, "bodies": {}})");
  for (const char* uri : {"../private.bin", "/etc/hostname", "sub/../../private.bin"}) {
    CAPTURE(uri);
    put("scene/m.gltf", std::string(R"({"asset": {"version": "2.0"}, "buffers": [{"uri": ")") +
                            uri + R"(", "byteLength": 4}]})");
    const auto files = pack_files((rig.folder / "scene/a.json").string());
    REQUIRE_FALSE(files.ok());
    CHECK(files.error().text().find("not in its folder") != std::string::npos);
  }
  put("scene/m.gltf",
      R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "gone.bin", "byteLength": 4}]})");
  CHECK_FALSE(pack_files((rig.folder / "scene/a.json").string()).ok());
  put("scene/m.gltf", R"({"asset": {"version": "2.0"}, "buffers": [
      {"uri": "b.bin", "byteLength": 4}, {"uri": "b.bin", "byteLength": 4}]})");
  put("scene/b.bin", "1234");
  const auto files = pack_files((rig.folder / "scene/a.json").string());
  REQUIRE_MESSAGE(files.ok(), test::why_not(files));
  CHECK(files->size() == 3);
  REQUIRE(write_pack(rig.file, *files));
  CHECK(read_pack(rig.file).ok());
}

TEST_CASE("an unpacked scene that has lost or changed files is whole again when it is opened") {
  const PackRig rig;
  const auto files = pack_files("cups_and_rings");
  REQUIRE(files.ok());
  REQUIRE(write_pack(rig.file, *files));
  const auto scene = unpack(rig.file);
  REQUIRE(scene.ok());
  const auto folder = scene->parent_path();
  const auto is_whole = [&] {
    const auto again = unpack(rig.file);
    REQUIRE_MESSAGE(again.ok(), test::why_not(again));
    CHECK(*again == *scene);
    for (const PackFile& f : *files) CHECK(file_text((folder / f.name).string()) == f.bytes);
    CHECK(std::distance(std::filesystem::directory_iterator(folder.parent_path()), {}) == 1);
  };
  std::filesystem::remove(folder / files->back().name);
  is_whole();
  std::filesystem::remove(*scene);
  is_whole();
  std::ofstream(folder / files->back().name, std::ios::binary) << "something else";
  is_whole();
}

TEST_CASE("an archive by another program is read, folders in it too") {
  const PackRig rig;
  rig.write(archive({{"meshes/", ""}, {"a.json", scene_text}, {"meshes/b.json", "{}"}}));
  const auto scene = unpack(rig.file);
  REQUIRE_MESSAGE(scene.ok(), test::why_not(scene));
  CHECK(file_text(scene->string()) == scene_text);
  CHECK(scene->filename() == "a.json");
  CHECK(file_text((scene->parent_path() / "meshes/b.json").string()) == "{}");
  CHECK(*unpack(rig.file) == *scene);
}

TEST_CASE("names that lead elsewhere are refused") {
  const PackRig rig;
  for (const char* name : {"../evil.json", "meshes/../../evil.json", "/tmp/evil.json", "a//b.json",
                           "./a.json", "..", "meshes/..", "a\\b.json", "C:evil.json"}) {
    CAPTURE(name);
    rig.refuses({{"a.json", scene_text}, {name, "{}"}}, "its name");
  }
  rig.refuses({{std::string("a\0.json", 7), scene_text}}, "");
  rig.refuses({{std::string(500, 'a'), scene_text}}, "its name");
  rig.refuses({{"a.json", scene_text}, {"a.json", scene_text}}, "two of this name");
}

TEST_CASE("links, passwords and unknown methods are refused") {
  const PackRig rig;
  rig.refuses({{"a.json", "/etc/passwd", 0120777u << 16}}, "it is a link");
  rig.refuses({{"a.json", scene_text, 0100644u << 16, 1}}, "encrypted");
  rig.refuses({{"a.json", scene_text, 0100644u << 16, 0, 12}}, "method 12");
}

TEST_CASE("an archive needs one scene") {
  const PackRig rig;
  rig.refuses(std::vector<Entry>{}, "");
  rig.refuses({{"meshes/a.json", scene_text}}, "no scene");
  rig.refuses({{"a.json", scene_text}, {"b.json", scene_text}}, "two scenes");
}

TEST_CASE("bombs are refused before they burst") {
  const PackRig rig;
  REQUIRE(write_pack(rig.file, {{"a.json", std::string(size_t{40} << 20, ' ')}}));
  CHECK(std::filesystem::file_size(rig.file) < 100000);
  rig.refuses("would become more than");
  // It claims little, and gives more: then the claim is wrong.
  REQUIRE(write_pack(rig.file, {{"a.json", std::string(size_t{1} << 20, ' ')}}));
  std::string bytes = file_text(rig.file.string());
  for (size_t at = bytes.find("PK\1\2"); at != std::string::npos; at = std::string::npos)
    bytes.replace(at + 24, 4, std::string("\5\0\0\0", 4));
  rig.write(bytes);
  rig.refuses("damaged");
  rig.refuses({{"a.json", scene_text, 0100644u << 16, 0, 0, 0xfffffff0u}}, "would become");
  PackLimits few;
  few.entries = 1;
  rig.write(archive({{"a.json", scene_text}, {"b", ""}}));
  CHECK_FALSE(read_pack(rig.file, few).ok());
}

TEST_CASE("an archive that ends early, or was changed anywhere, is refused or the same") {
  const PackRig rig;
  std::string large;
  for (int i = 0; i < 2000; ++i) large += std::to_string(i * 7919 % 1000) + " ";
  REQUIRE(write_pack(rig.file, {{"a.json", scene_text}, {"meshes/m/m.obj", large}}));
  const std::string whole = file_text(rig.file.string());
  // Of the end of the directory a byte or two are not missed: then everything is there.
  const auto sound = [&](const std::string& bytes) {
    rig.write(bytes);
    const auto got = read_pack(rig.file);
    if (!got) return false;
    for (const PackFile& f : *got) CHECK((f.bytes == scene_text || f.bytes == large));
    return true;
  };
  for (size_t length = 0; length < whole.size(); length += length < 200 ? 1 : 37)
    if (sound(whole.substr(0, length))) CHECK(length + 3 > whole.size());
  for (size_t at = 0; at < whole.size(); at += 3)
    for (const int bit : {0, 3, 7}) {
      std::string changed = whole;
      changed[at] = char(changed[at] ^ (1 << bit));
      (void)sound(changed);
    }
}
