#include "catch.hpp"
#include "io/files.hpp"
#include "io/xml.hpp"

#include <dem/report/html_report.hpp>

#include <string>

namespace html_report_test {

using namespace dem::io;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("text is escaped for XML and HTML") {
  CHECK(escape_xml("a < b & \"c\" > 'd'") == "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  CHECK(escape_xml("τ = 1\n\tkPa\x01\x1b") == "τ = 1\n\tkPa");
}

TEST_CASE("base64 agrees with RFC 4648") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
  CHECK(base64("fooba") == "Zm9vYmE=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE("a report is one well-formed page with nothing from outside") {
  const TempFolder folder;
  const std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"><g id=\"a\"/></svg>";
  write_file(folder / "a.svg", svg);
  write_file(folder / "b.png", "\x89PNG");
  Table table{.caption = "By <packing>", .header = {"packing", "angle [deg]", "n"}, .align = {{}, {}, Align::Center}};
  table.row("<script>", 25.123, 1).row("dense & wet", "-", 2);

  HtmlReport report("Shear & <more>");
  report.paragraph("first < paragraph\n\nsecond")
      .heading("Settings")
      .heading("below", 7)
      .settings({{"\"grains\"", "14256"}, {"mu", "0.4 & more"}})
      .table(table)
      .picture(folder / "a.svg", "Curve \"1\"")
      .picture(folder / "b.png")
      .svg(svg)
      .preformatted("./shear --size <n>\n  --out x");
  report.save(folder / "out/report.html");
  const std::string page = read_file(folder / "out/report.html");
  CHECK(page == report.html());
  CHECK(!std::filesystem::exists(folder / "out/report.html.tmp"));

  const auto tags = XmlReader::tags(page);
  for (const auto& tag : tags) {
    CHECK(tag.name != "script");
    CHECK(tag.name != "link");
    if (tag.name == "img") CHECK(tag.at("src").substr(0, 11) == "data:image/");
  }
  CHECK_THAT(page, !ContainsSubstring("http") && !ContainsSubstring("url(") && !ContainsSubstring("@import"));
  CHECK_THAT(page, ContainsSubstring("<title>Shear &amp; &lt;more&gt;</title>") &&
                       ContainsSubstring("<h1>Shear &amp; &lt;more&gt;</h1>"));
  CHECK_THAT(page, ContainsSubstring("<p>first &lt; paragraph</p>\n<p>second</p>\n"));
  CHECK_THAT(page, ContainsSubstring("<h2>Settings</h2>") && ContainsSubstring("<h3>below</h3>"));
  CHECK_THAT(page, ContainsSubstring("<dt>&quot;grains&quot;</dt><dd>14256</dd>") &&
                       ContainsSubstring("<dd>0.4 &amp; more</dd>"));
  CHECK_THAT(page, ContainsSubstring("<caption>By &lt;packing&gt;</caption>"));
  CHECK_THAT(page,
             ContainsSubstring("<th>packing</th><th class=\"right\">angle [deg]</th><th class=\"center\">n</th>"));
  CHECK_THAT(page,
             ContainsSubstring("<td>&lt;script&gt;</td><td class=\"right\">25.12</td><td class=\"center\">1</td>"));
  CHECK_THAT(page, ContainsSubstring("<img alt=\"Curve &quot;1&quot;\" src=\"data:image/svg+xml;base64," + base64(svg) +
                                     "\">"
                                     "<figcaption>Curve &quot;1&quot;</figcaption>"));
  CHECK_THAT(page, ContainsSubstring("<img alt=\"\" src=\"data:image/png;base64,iVBORw==\"></figure>"));
  CHECK_THAT(page, ContainsSubstring("<pre>./shear --size &lt;n&gt;\n  --out x</pre>"));
}

TEST_CASE("what cannot stand in a report is refused") {
  const TempFolder folder;
  HtmlReport report("R");
  CHECK(error_of([&] { report.picture("plot.pdf"); }) ==
        "report 'R': the picture 'plot.pdf' is neither .svg nor .png; convert it");
  CHECK(error_of([&] { report.picture(folder / "none.svg"); }) ==
        "cannot read the file '" + (folder / "none.svg").string() + "'; check that it exists and may be read");
  CHECK(error_of([&] {
          report.table(Table{.caption = "T", .header = {"a"}, .rows = {{"1", "2"}}});
        }) == "table 'T': row 0 has 2 cells, but the header has 1; give one cell a column");
}

TEST_CASE("bytes that are no UTF-8 become the replacement character, all others stay") {
  const std::string none = "\xEF\xBF\xBD";
  for (const std::string whole : {"plain", "τ²", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                                  "\xF4\x8F\xBF\xBF", "\xEF\xBF\xBD", "a\nb\tc"}) {
    CHECK(to_utf8(whole) == whole);
  }
  CHECK(to_utf8("a\x80z") == "a" + none + "z");                     // a byte that only follows
  CHECK(to_utf8("\xC3") == none);                                   // cut off
  CHECK(to_utf8("\xE2\x82z") == none + none + "z");                 // cut off, and something else behind
  CHECK(to_utf8("\xC0\xAF") == none + none);                        // '/' in two bytes
  CHECK(to_utf8("\xE0\x80\xAF") == none + none + none);             // in three
  CHECK(to_utf8("\xED\xA0\x80") == none + none + none);             // half of a pair of UTF-16
  CHECK(to_utf8("\xF4\x90\x80\x80") == none + none + none + none);  // beyond the last code point
  CHECK(to_utf8("\xFF\xFE") == none + none);
  CHECK(to_utf8("\xEF\xBF\xBF") == none + none + none);  // U+FFFF, which XML forbids
  CHECK(escape_xml("<\xE9\x01>") == "&lt;" + none + "&gt;");
  const std::string page = HtmlReport("caf\xE9").paragraph("\xFF").html();
  CHECK(page == to_utf8(page));
}

}  // namespace html_report_test
