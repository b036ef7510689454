#include "catch.hpp"
#include "core/error_of.hpp"
#include "io/files.hpp"

#include <dem/report/html_report.hpp>
#include <dem/report/replay_page.hpp>

#include <cstdlib>
#include <string>
#include <vector>

namespace replay_page_test {

using namespace dem::report;
using Catch::Matchers::ContainsSubstring;

namespace {

/// Sets DEM_THREE_JS, and puts back what it was.
class ThreeJsAt {
 public:
  explicit ThreeJsAt(const std::string& path) {
    if (const char* old = std::getenv("DEM_THREE_JS")) before_ = old;
    ::setenv("DEM_THREE_JS", path.c_str(), 1);
  }
  ThreeJsAt(const ThreeJsAt&) = delete;
  ThreeJsAt& operator=(const ThreeJsAt&) = delete;
  ~ThreeJsAt() { before_.empty() ? ::unsetenv("DEM_THREE_JS") : ::setenv("DEM_THREE_JS", before_.c_str(), 1); }

 private:
  std::string before_;
};

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

Replay two_frames(const ReplayOptions& options = {}) {
  Replay replay(options);
  replay.add_shape({.balls = {{dem::Vec3::Zero(), 1.0}}, .mesh = {}, .smooth_angle = 0.0});
  for (const double t : {0.0, 1.0}) replay.record(t, std::vector<ReplayGrain>{{.number = 0, .position = {t, 0, 0}}});
  return replay;
}

}  // namespace

TEST_CASE("a report holds three.js and the viewer once, and the numbers of each replay") {
  const TempFolder folder;
  dem::io::write_file(folder / "three.min.js", "self.THREE={};\"</script>\";");
  const ThreeJsAt three((folder / "three.min.js").string());
  dem::io::HtmlReport report("Two replays");
  report.replay(two_frames(), "The <first>.").paragraph("Between.").replay(two_frames());
  const std::string page = report.html();
  CHECK(count_of(page, "<figure class=\"replay\">") == 2);
  CHECK(count_of(page, "class=\"data\">eJ") == 2);  // base64 of the first bytes of a zlib stream
  CHECK(count_of(page, "self.THREE={};\"<\\/script>\";") == 1);
  CHECK(count_of(page, "class Orbit") == 1);
  CHECK(count_of(page, "<script>") == 2);
  CHECK(count_of(page, "</script>") == 2 + 2 * 2);
  CHECK(page.find("class Orbit") > page.find("</main>"));
  CHECK(count_of(page, ".replay .view {") == 1);
  CHECK_THAT(page, ContainsSubstring("<figcaption>The &lt;first&gt;.</figcaption>"));
  CHECK_THAT(page, !ContainsSubstring("http"));

  // A report without a replay has neither.
  const std::string plain = dem::io::HtmlReport("None").html();
  CHECK_THAT(plain, !ContainsSubstring("<script") && !ContainsSubstring("replay"));
}

TEST_CASE("the option goes before the variable, and what is no three.js is refused before the run") {
  const TempFolder folder;
  dem::io::write_file(folder / "own.js", "var THREE = {};");
  dem::io::write_file(folder / "module.js", "export { Scene };");
  const std::string own = (folder / "own.js").string(), module = (folder / "module.js").string();
  const ThreeJsAt three(module);
  CHECK_THAT(replay_page(two_frames({.three_js = own})).scripts, ContainsSubstring("var THREE = {};"));
  check_refused([] { Replay(); }, "module.js' is not three.js as one script", "three.min.js");
  check_refused([&] { Replay({.three_js = own + "x"}); }, "three.js cannot be read from", "own.jsx", "DEM_THREE_JS");
  check_refused([&] { Replay({.three_js = module}); }, "is not three.js");
}

TEST_CASE("without three.js the report says what to install, and nothing else is missing from it") {
  const TempFolder folder;
  dem::io::write_file(folder / "three.min.js", "self.THREE={};");
  const ThreeJsAt three((folder / "three.min.js").string());
  const Replay replay = two_frames();
  std::filesystem::remove(folder / "three.min.js");
  dem::io::HtmlReport report("A replay");
  const std::string page = report.replay(replay, "A caption.").paragraph("After it.").html();
  CHECK_THAT(page, ContainsSubstring(
                       "Install libjs-three (on Debian: apt-get install libjs-three) and make this report again"));
  CHECK_THAT(page, ContainsSubstring("A caption.") && ContainsSubstring("After it.") && !ContainsSubstring("<script"));

  dem::io::write_file(folder / "three.min.js", "self.THREE={};");
  const Replay empty;
  check_refused([&] { (void)replay_page(empty); }, "has no frames");
}

}  // namespace replay_page_test
