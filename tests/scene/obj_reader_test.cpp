// Object files in our own reader. References: what each file says, written here by hand, with
// doubles as the compiler reads them; volumes of the box and the prism in closed form; the line at
// which a damaged file is wrong.
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/mesh_files/polygon_file.hpp"
#include "engine/scene/mesh_import.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/why_not.hpp"

#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace tumble;

namespace {

/// What is read of a file of this text.
class ObjText {
 public:
  Result<PolygonFile> operator()(const std::string& text) const {
    std::ofstream(file(), std::ios::binary) << text;
    return read_obj(file());
  }
  std::filesystem::path file() const { return folder_.path() / "a.obj"; }

  /// The fault of a text, which must be at this line.
  void refuses(const std::string& text, int line, const char* why) const {
    CAPTURE(text.substr(0, 200));
    const auto got = (*this)(text);
    REQUIRE_FALSE(got.ok());
    CHECK(got.error().place == fmt::format("{}:{}", file().string(), line));
    CHECK_MESSAGE(got.error().message.find(why) != std::string::npos, got.error().message);
  }

 private:
  TempFolder folder_;
};

const std::string three_points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("coordinates of an object file keep all digits of doubles") {
  const ObjText read;
  const auto got = read(
      "v 1.0000000001 -0.12345678901234567 +1e-3\nv 16777217 5e-324 .5\n"
      "v 1 2 3 0.9 0.8 0.7\nv 1 2 3 2\nf 1 2 3 4\n");
  REQUIRE_MESSAGE(got.ok(), test::why_not(got));
  CHECK(got->vertices == std::vector<Vec3>{{1.0000000001, -0.12345678901234567, 1e-3},
                                           {16777217, 5e-324, 0.5},
                                           {1, 2, 3},        // with a colour
                                           {0.5, 1, 1.5}});  // with a weight
  const auto mesh = import_mesh(read.file());
  REQUIRE(mesh.ok());
  CHECK(mesh->mesh.vertices[0] == got->vertices[0]);
}

TEST_CASE("faces of an object file: corners in every form, polygons, ends and goings-on of lines") {
  const ObjText read;
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const std::vector<uint32_t> square{0, 1, 2, 3};
  for (const char* face :
       {"f 1 2 3 4", "f 1/5 2/6 3/7 4/8", "f 1//5 2//6 3//7 4//8", "f 1/5/9 2/-6/9 3/7/-9 4/8/9",
        "f -4 -3 -2 -1", "f -4//1 2 -2/3 4/", "  f\t1   2\t3 4  # a square",
        "# no more \\\nf 1 2 3 4", "f 1 2 \\\n 3 \\\n4", "f 1 2 \\\r\n 3 4\r\nl 1 2 3\r\np 1\r\n",
        "vn 0 0 1\nvt 0 0\ns off\nmtllib a b.mtl\nf 1 2 3 4\nf 1 2\nfo 1 2 3\n",
        "f 1 2 3 4\n\n\r\n#"}) {
    CAPTURE(face);
    const auto got = read(points + face);
    REQUIRE_MESSAGE(got.ok(), test::why_not(got));
    CHECK(got->corners == square);
    CHECK(got->polygon_first == std::vector<size_t>{0, 4});
    CHECK(got->vertices.size() == 4);
  }
  // Lines that end with a carriage return alone, a mark of UTF-8, faces before their vertices.
  const auto got = read(
      "\xef\xbb\xbf"
      "f 1 2 3\rv 1 0 0\rv 2 0 0\rv 3 1 0\r");
  REQUIRE(got.ok());
  CHECK(got->vertices == std::vector<Vec3>{{1, 0, 0}, {2, 0, 0}, {3, 1, 0}});
}

TEST_CASE("objects, groups and materials of an object file are parts with vertices of their own") {
  const ObjText read;
  const auto got = read(three_points +
                        "v 0 0 1\no base\ng\nusemtl red\ng a b \nf 4 3 2\nf 1 2 4\nusemtl red\n"
                        "f 1 2 3\nusemtl blue\nf 2 3 4\no empty\no last\nf 3 2 1\n");
  REQUIRE_MESSAGE(got.ok(), test::why_not(got));
  REQUIRE(got->parts.size() == 3);
  CHECK(got->parts[0].name == "a b");
  CHECK(got->parts[1].name == "a b");
  CHECK(got->parts[2].name == "last");
  CHECK(got->parts[1].first_polygon == 3);
  CHECK(got->parts[1].first_vertex == 4);
  CHECK(got->parts[2].first_vertex == 7);
  CHECK(got->corners == std::vector<uint32_t>{0, 1, 2, 3, 2, 0, 3, 2, 1, 4, 5, 6, 7, 8, 9});
  CHECK(got->vertices[0] == Vec3(0, 0, 1));
  CHECK(got->vertices[7] == Vec3(0, 1, 0));
  CHECK(read(three_points + "f 1 2 3\n")->parts[0].name == "a");  // the file's
}

TEST_CASE("a prism over an L in an object file has its volume") {
  const ObjText read;
  REQUIRE(read("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
               "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
               "f 6 5 4 3 2 1\nf -6 -5 -4 -3 -2 -1\n"
               "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n")
              .ok());
  const auto mesh = import_mesh(read.file());
  REQUIRE(mesh.ok());
  CHECK(mesh_mass(mesh->mesh)->mass == doctest::Approx(3).epsilon(1e-14));
}

TEST_CASE("damaged object files are refused at the line that is wrong") {
  const ObjText read;
  read.refuses("v 0 0 0\nv nan 0 0\n", 2, "'nan' is not finite");
  read.refuses("v 0 0 inf\n", 1, "'inf' is not finite");
  read.refuses("v 0 1e999 0\n", 1, "'1e999' is not finite");
  read.refuses("v 0 0\n", 1, "fewer than three");
  read.refuses("v 0 0 0x10\n", 1, "'0x10' is not finite or no number");
  read.refuses("v 0 0 0 0\n", 1, "weight 0");
  read.refuses("v 0 0 0 x\n", 1, "'x'");
  read.refuses(three_points + "\n# a\nf 1 2 0\n", 6, "corner 0");
  read.refuses(three_points + "f 1 2 4\nf 1 2 3\n", 4, "the corner 4, but there are 3 vertices");
  read.refuses(three_points + "f 1 2 -4\nv 1 1 1\n", 4, "only 3 vertices stand before");
  read.refuses(three_points + "f 1 2 4294967297\n", 4, "the corner 4294967297");
  read.refuses(three_points + "f 1 2 9223372036854775807\n", 4, "the corner 9223372036854775807");
  read.refuses(three_points + "f 1 2 -9223372036854775808\n", 4, "only 3");
  read.refuses(three_points + "f 1 2 99999999999999999999\n", 4, "is no corner");
  read.refuses(three_points + "f 1 2 3.5\n", 4, "'3.5' is no corner");
  read.refuses(three_points + "f 1 2 3x\n", 4, "'3x' is no corner");
  read.refuses(three_points + "f 1 2 /3\n", 4, "'/3' is no corner");
  read.refuses(three_points + "f 1 2 3/x\n", 4, "'3/x' is no corner");
  // Lines are counted as an editor does, and a statement is where it begins.
  read.refuses("v 0 0 \\\n0\r\n\r\nf 1 \\\n2 \\\n3\n", 4, "the corner 3");
  read.refuses("v 0 0 0\rv 0 0 z\r", 2, "'z'");
}

TEST_CASE("object files without faces, of backslashes or of noise have no triangles, and soon") {
  const ObjText read;
  for (const std::string& text :
       {std::string("v 0 0 0\nv 1 0 0\n"), std::string("\\"), std::string("\n\n\n"),
        std::string(1 << 20, '\\'), std::string(1 << 20, '\0'), std::string(1 << 20, '\x80')}) {
    const auto got = read(text);
    REQUIRE(got.ok());
    CHECK(got->parts.empty());
    const auto mesh = import_mesh(read.file());
    REQUIRE_FALSE(mesh.ok());
    CHECK(mesh.error().message.find("no triangles") != std::string::npos);
  }
  std::string long_statement = three_points + "f";
  for (int i = 0; i < 300'000; ++i) long_statement += " \\\n1 2 3";
  const auto got = read(long_statement);
  REQUIRE(got.ok());
  CHECK(got->corners.size() == 900'000);
  CHECK(got->vertices.size() == 3);
}
