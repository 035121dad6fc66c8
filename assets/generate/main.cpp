// generate_assets DIRECTORY: writes every mesh of the catalogue as DIRECTORY/NAME.obj (or .off) and
// prints the table of assets/README.md. Exit 1 when a mesh fails its audit, 2 on bad usage, 5 when
// a file cannot be written.
#include "assets/generate/audit.hpp"
#include "assets/generate/catalogue.hpp"

#include <fstream>

#include <fmt/format.h>

int main(int argc, char** argv) {
  using namespace tumble::assets;
  if (argc != 2) {
    fmt::print(stderr, "usage: generate_assets DIRECTORY (normally assets/meshes)\n");
    return 2;
  }
  bool sound = true;
  for (const Asset& asset : all_assets()) {
    const Mesh mesh = asset.make();
    const Audit report = audit(mesh);
    for (const std::string& fault : report.faults) {
      fmt::print(stderr, "{}: {}\n", asset.name, fault);
      sound = false;
    }
    if (!report.faults.empty()) continue;
    const std::string path = fmt::format("{}/{}", argv[1], file_name(asset));
    std::ofstream file(path, std::ios::binary);
    file << file_text(asset, mesh);
    file.close();
    if (!file) {
      fmt::print(stderr, "{}: cannot be written; does the directory exist?\n", path);
      return 5;
    }
    fmt::print("{}\n", table_row(asset));
  }
  return sound ? 0 : 1;
}
