#pragma once
// A report of a run: one HTML file with everything inside it.

#include <dem/core/error.hpp>
#include <dem/io/escape.hpp>
#include <dem/io/file.hpp>
#include <dem/report/base64.hpp>
#include <dem/report/html_style.hpp>
#include <dem/report/table.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::io {

/// Builds one HTML file with no link to anything outside, and no script unless there is a replay in it. All texts are
/// plain and get escaped. Methods return the report, so that calls can be chained.
///
///     HtmlReport report("Direct shear test");
///     report.paragraph("Four normal stresses.")
///         .settings({{"grains", "14256"}, {"friction", "0.4"}})
///         .table(table)
///         .picture("out/shear.svg", "Shear stress over displacement.");
///     report.save("out/report.html");
class HtmlReport {
 public:
  explicit HtmlReport(std::string title) : title_(std::move(title)) {}

  /// A heading; `level` 2 (section) or 3 (below it), others are brought into that range.
  HtmlReport& heading(std::string_view text, int level = 2) {
    const int h = level <= 2 ? 2 : 3;
    body_ += fmt::format("<h{0}>{1}</h{0}>\n", h, escape_xml(text));
    return *this;
  }

  /// A paragraph; an empty line in `text` starts another one.
  HtmlReport& paragraph(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.find("\n\n");
      body_ += fmt::format("<p>{}</p>\n", escape_xml(text.substr(0, end)));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
    }
    return *this;
  }

  /// Text whose spaces and line ends stay, e.g. a command line.
  HtmlReport& preformatted(std::string_view text) {
    body_ += fmt::format("<pre>{}</pre>\n", escape_xml(text));
    return *this;
  }

  /// Names and values, e.g. of the run's settings.
  HtmlReport& settings(const std::vector<std::pair<std::string, std::string>>& values) {
    body_ += "<dl>\n";
    for (const auto& [name, value] : values) {
      body_ += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_xml(name), escape_xml(value));
    }
    body_ += "</dl>\n";
    return *this;
  }

  /// A table; columns of numbers stand right-aligned unless Table::align says otherwise. Throws dem::Error for a row
  /// of wrong length.
  HtmlReport& table(const Table& table) {
    check_table(table);
    body_ += "<div class=\"scroll\"><table>\n";
    if (!table.caption.empty()) body_ += fmt::format("<caption>{}</caption>\n", escape_xml(table.caption));
    body_ += "<thead>";
    add_row(table, table.header, "th");
    body_ += "</thead>\n<tbody>\n";
    for (const auto& row : table.rows) add_row(table, row, "td");
    body_ += "</tbody>\n</table></div>\n";
    return *this;
  }

  /// A picture file (.svg or .png), copied into the report. Each is an image of its own, so that ids inside several
  /// SVGs cannot meet. `caption` stands below it and is read out in its place. Throws dem::Error when the file cannot
  /// be read or has another ending.
  HtmlReport& picture(const std::filesystem::path& file, std::string_view caption = "") {
    const auto ending = file.extension();
    if (ending != ".svg" && ending != ".png") {
      fail("report '{}': the picture '{}' is neither .svg nor .png; convert it", title_, file.string());
    }
    return picture_data(ending == ".svg" ? "image/svg+xml" : "image/png", read_file(file), caption);
  }

  /// The same with the text of an SVG.
  HtmlReport& svg(std::string_view text, std::string_view caption = "") {
    return picture_data("image/svg+xml", text, caption);
  }

  /// A recorded run to be turned and watched; `caption` stands below it. Takes a dem::report::Replay, and needs
  /// <dem/report/replay.hpp>. Where three.js is not installed the page says so in its place. Throws dem::Error when no
  /// frame was recorded.
  template <class Replay>
  HtmlReport& replay(const Replay& replay, std::string_view caption = "") {
    const auto page = replay_page(replay, caption);
    body_ += page.figure;
    style_ = page.style;
    if (!page.scripts.empty()) scripts_ = page.scripts;
    return *this;
  }

  /// The whole page.
  [[nodiscard]] std::string html() const {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>{0}</title>\n<style>\n{1}{3}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n{2}</main>\n{4}"
        "</body>\n</html>\n",
        escape_xml(title_), detail::kHtmlStyle, body_, style_, scripts_);
  }

  /// Writes the page, complete or not at all. Throws dem::Error when that is not possible.
  void save(const std::filesystem::path& path) const { write_file(path, html()); }

 private:
  void add_row(const Table& table, const std::vector<std::string>& cells, std::string_view tag) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Align align = column_align(table, c);
      const std::string_view attribute = align == Align::Right    ? " class=\"right\""
                                         : align == Align::Center ? " class=\"center\""
                                                                  : "";
      body_ += fmt::format("<{0}{1}>{2}</{0}>", tag, attribute, escape_xml(cells[c]));
    }
    body_ += "</tr>\n";
  }

  HtmlReport& picture_data(std::string_view type, std::string_view bytes, std::string_view caption) {
    body_ +=
        fmt::format("<figure><img alt=\"{}\" src=\"data:{};base64,{}\">", escape_xml(caption), type, base64(bytes));
    if (!caption.empty()) body_ += fmt::format("<figcaption>{}</figcaption>", escape_xml(caption));
    body_ += "</figure>\n";
    return *this;
  }

  std::string title_, body_;
  std::string style_, scripts_;  // of replays
};

}  // namespace dem::io
