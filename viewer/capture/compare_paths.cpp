#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/compare.hpp"
#include "viewer/capture/png.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace tumble {
namespace fs = std::filesystem;
namespace {

bool is_picture(const fs::path& file) {
  static constexpr std::array known = {".png", ".jpg", ".jpeg", ".bmp", ".tga", ".ppm", ".pgm"};
  return std::find(known.begin(), known.end(), file.extension().string()) != known.end();
}

Result<std::set<std::string>> pictures_of(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
    if (is_picture(it->path()) && !it->path().filename().string().starts_with('.'))
      names.insert(it->path().filename().string());
  if (code) return Error{ErrorCode::io, "cannot list: " + code.message(), folder.string(), {}};
  return names;
}

/// Copies `actual` to `expected`, byte for byte.
Status bless(const fs::path& expected, const fs::path& actual) {
  auto content = read_file(actual);
  if (!content) return content.error();
  if (!expected.parent_path().empty())
    if (auto made = make_folder(expected.parent_path()); !made) return made;
  return write_file(expected, *content);
}

/// Compares one pair; writes the difference image if requested.
CompareOutcome compare_pair(const std::string& name, const fs::path& expected,
                            const fs::path& actual, const fs::path& diff,
                            const CompareOptions& options) {
  FileComparison file{.name = name, .difference = {}, .error = {}};
  std::error_code code;
  const auto b = read_image(actual);
  if (!b) return CompareFailure{b.error()};
  if (options.bless && !fs::exists(expected, code)) {
    file.kind = FileComparison::Kind::only_actual;
    return ComparisonReport{{file}};
  }
  const auto a = read_image(expected);
  if (!a) return CompareFailure{a.error()};
  file.difference = compare_images(*a, *b, options.limits.tolerance);
  file.equal = within(file.difference, options.limits);
  if (!diff.empty() && file.difference.same_size)
    if (auto s = write_png(diff, difference_image(*a, *b, options.limits.tolerance)); !s)
      return CompareFailure{s.error(), true};
  return ComparisonReport{{file}};
}

CompareOutcome compare_folders(const fs::path& expected, const fs::path& actual,
                               const CompareOptions& options) {
  const auto a = pictures_of(expected);
  if (!a) return CompareFailure{a.error()};
  const auto b = pictures_of(actual);
  if (!b) return CompareFailure{b.error()};
  std::set<std::string> names = *a;
  names.insert(b->begin(), b->end());
  if (names.empty())
    return CompareFailure{{ErrorCode::not_found,
                           "no pictures in either folder",
                           expected.string() + ", " + actual.string(),
                           {}}};
  if (!options.diff.empty())
    if (auto s = make_folder(options.diff); !s) return CompareFailure{s.error(), true};

  ComparisonReport report;
  for (const std::string& name : names) {
    if (!a->contains(name) || !b->contains(name)) {
      using Kind = FileComparison::Kind;
      FileComparison lone{.name = name, .difference = {}, .error = {}};
      lone.kind = a->contains(name) ? Kind::only_expected : Kind::only_actual;
      report.files.push_back(lone);
      continue;
    }
    const fs::path diff =
        options.diff.empty() ? fs::path{} : (options.diff / name).replace_extension(".png");
    auto one = compare_pair(name, expected / name, actual / name, diff, options);
    if (auto* failure = std::get_if<CompareFailure>(&one)) {
      if (failure->cannot_write) return *failure;
      FileComparison unreadable{.name = name, .difference = {}, .error = failure->error};
      unreadable.kind = FileComparison::Kind::unreadable;
      report.files.push_back(std::move(unreadable));
      continue;
    }
    report.files.push_back(std::get<ComparisonReport>(one).files.front());
  }
  // Files that need attention come first; each group is sorted by name.
  std::stable_partition(report.files.begin(), report.files.end(),
                        [](const FileComparison& f) { return !f.equal; });
  return report;
}

}  // namespace

bool ComparisonReport::equal() const {
  return std::all_of(files.begin(), files.end(), [](const FileComparison& f) { return f.equal; });
}

size_t ComparisonReport::count(FileComparison::Kind kind) const {
  return size_t(std::count_if(files.begin(), files.end(),
                              [kind](const FileComparison& f) { return f.kind == kind; }));
}

CompareOutcome compare_paths(const fs::path& expected, const fs::path& actual,
                             const CompareOptions& options) {
  std::error_code code;
  const bool folder_a = fs::is_directory(expected, code), folder_b = fs::is_directory(actual, code);
  const bool missing_a = !fs::exists(expected, code);
  if (folder_a != folder_b && !(options.bless && missing_a))
    return CompareFailure{
        {ErrorCode::invalid_argument, "one is a folder and the other is not, or does not exist",
         expected.string() + ", " + actual.string(), "compare two pictures or two folders"}};
  const bool folders = folder_b;
  if (folders && missing_a)
    if (auto s = make_folder(expected); !s) return CompareFailure{s.error(), true};
  CompareOutcome outcome =
      folders ? compare_folders(expected, actual, options)
              : compare_pair(actual.filename().string(), expected, actual, options.diff, options);
  auto* report = std::get_if<ComparisonReport>(&outcome);
  if (!report || !options.bless) return outcome;
  for (const FileComparison& f : report->files) {
    if (f.equal || f.kind == FileComparison::Kind::only_expected ||
        f.kind == FileComparison::Kind::unreadable)
      continue;
    const fs::path to = folders ? expected / f.name : expected;
    const fs::path from = folders ? actual / f.name : actual;
    if (auto s = bless(to, from); !s) return CompareFailure{s.error(), true};
    report->blessed = true;
  }
  return outcome;
}

}  // namespace tumble
