#include "viewer/capture/compare.hpp"

#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/options.hpp"
#include "viewer/capture/frame_clock.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct CompareLine {
  std::string expected, actual, diff;
  std::string tolerance = "2", max_differing = "0.001";
  uint64_t max_cluster = 16;
  bool bless = false, json = false;
};

/// Parses a tolerance in steps of 1/255: "2" or "2/255"; a value with a fraction below 1 is one of
/// the full range.
Result<double> tolerance_steps(const std::string& text) {
  const auto value = parse_fraction(text, "--tolerance", true);
  if (!value) return value.error();
  const bool share = text.find('/') != std::string::npos;
  const double steps = share ? 255 * value->value() : value->value();
  if (steps > 255)
    return Error{ErrorCode::invalid_argument, "--tolerance: the largest difference is 255", {}, {}};
  return steps;
}

/// Parses a share: "0.001" or "0.1%".
Result<double> share_of(std::string text) {
  const bool percent = text.ends_with('%');
  if (percent) text.pop_back();
  const auto value = parse_fraction(text, "--max-differing", true);
  if (!value) return value.error();
  const double share = percent ? value->value() / 100 : value->value();
  if (share > 1)
    return Error{
        ErrorCode::invalid_argument, "--max-differing: a share is at most 1 or 100%", {}, {}};
  return share;
}

std::string_view kind_text(const FileComparison& file) {
  switch (file.kind) {
    case FileComparison::Kind::only_expected:
      return "only the expected one is there";
    case FileComparison::Kind::only_actual:
      return "only the actual one is there";
    case FileComparison::Kind::unreadable:
      return "cannot be read";
    case FileComparison::Kind::compared:
      break;
  }
  return file.difference.same_size ? "" : "sizes differ";
}

/// "12 pictures: 9 equal, 1 different, 1 missing, 1 unreadable"
std::string summary(const ComparisonReport& report) {
  using Kind = FileComparison::Kind;
  const size_t equal = size_t(std::count_if(report.files.begin(), report.files.end(),
                                            [](const FileComparison& f) { return f.equal; }));
  return fmt::format("{} pictures: {} equal, {} different, {} missing, {} unreadable",
                     report.files.size(), equal, report.count(Kind::compared) - equal,
                     report.count(Kind::only_expected) + report.count(Kind::only_actual),
                     report.count(Kind::unreadable));
}

void print_lines(const ComparisonReport& report) {
  for (const FileComparison& f : report.files) {
    const std::string_view kind = kind_text(f);
    const ImageDifference& d = f.difference;
    if (f.kind == FileComparison::Kind::unreadable)
      fmt::print("{}: {}: {}\n", f.name, kind, f.error.text());
    else if (!kind.empty())
      fmt::print("{}: {}\n", f.name, kind);
    else
      fmt::print("{}: {}, max {}/255, mean {:.4f}/255, {:.4f} % of pixels, largest cluster {}\n",
                 f.name, f.equal ? "equal" : "DIFFERENT", d.max_difference, d.mean_difference,
                 100 * d.share(), d.largest_cluster);
  }
  if (report.files.size() > 1) fmt::print("{}\n", summary(report));
  if (report.blessed) fmt::print("the expected pictures were renewed\n");
}

void print_json(const ComparisonReport& report) {
  nlohmann::ordered_json out;
  out["equal"] = report.equal();
  out["blessed"] = report.blessed;
  out["files"] = nlohmann::ordered_json::array();
  for (const FileComparison& f : report.files) {
    const ImageDifference& d = f.difference;
    nlohmann::ordered_json one = {{"name", f.name}, {"equal", f.equal}};
    if (const auto kind = kind_text(f); !kind.empty()) {
      one["reason"] = kind;
      if (f.kind == FileComparison::Kind::unreadable) one["error"] = f.error.text();
    } else {
      one["max_difference"] = d.max_difference;
      one["mean_difference"] = d.mean_difference;
      one["pixels"] = d.pixels;
      one["differing_pixels"] = d.differing;
      one["differing_share"] = d.share();
      one["largest_cluster"] = d.largest_cluster;
    }
    out["files"].push_back(std::move(one));
  }
  fmt::print("{}\n", out.dump(2));
}

int run_compare(const CompareLine& line) {
  CompareOptions options;
  const auto tolerance = tolerance_steps(line.tolerance);
  if (!tolerance) return report(tolerance.error(), exit_usage);
  const auto share = share_of(line.max_differing);
  if (!share) return report(share.error(), exit_usage);
  options.limits = {*tolerance, *share, line.max_cluster};
  options.diff = line.diff;
  options.bless = line.bless;

  const FileRoles files =
      FileRoles().reads(line.expected).reads(line.actual).writes("--diff", line.diff);
  if (const Status apart = files.apart(); !apart) return report(apart.error(), exit_usage);
  const CompareOutcome outcome = compare_paths(line.expected, line.actual, options);
  if (const auto* failure = std::get_if<CompareFailure>(&outcome))
    return report(failure->error, failure->cannot_write ? exit_cannot_write : exit_bad_input);
  const auto& result = std::get<ComparisonReport>(outcome);
  line.json ? print_json(result) : print_lines(result);
  if (result.count(FileComparison::Kind::unreadable) > 0) return exit_bad_input;
  return result.equal() || line.bless ? exit_ok : exit_negative;
}

}  // namespace

CommandAction declare_compare(Options& options) {
  auto line = std::make_shared<CompareLine>();
  options.value("expected", line->expected, "picture or folder that is right").required();
  options.value("actual", line->actual, "picture or folder to judge").required();
  options
      .value("--tolerance", line->tolerance,
             "difference of a channel that does not count, in steps of 255 or as 2/255")
      .shows_default();
  options
      .value("--max-differing", line->max_differing,
             "share of pixels that may differ by more, as 0.001 or 0.1%")
      .shows_default();
  options
      .value("--max-cluster", line->max_cluster,
             "the largest group of touching such pixels must be smaller than this")
      .natural()
      .shows_default();
  options
      .value("--diff", line->diff,
             "write a picture of the differences (a folder when folders are compared)")
      .not_empty();
  options.flag("--bless", line->bless, "make the actual pictures the expected ones");
  options.flag("--json", line->json, "one JSON object on stdout");
  options.footer(
      "Equal (0), different or of unequal size (1), unreadable (3). Of folders what differs is "
      "listed\n"
      "first; a file that cannot be read does not keep the others from being compared.\n\n"
      "Examples:\n"
      "  tumble compare golden/tower.png out/frame_000060.png --diff diff.png\n"
      "  tumble compare golden/ out/ --max-differing 0 --tolerance 0\n"
      "  tumble compare golden/ out/ --bless");
  return [line] { return run_compare(*line); };
}

}  // namespace tumble
