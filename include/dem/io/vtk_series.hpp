#pragma once
// Time series for ParaView (.pvd).

#include <dem/core/error.hpp>
#include <dem/io/escape.hpp>
#include <dem/io/file.hpp>
#include <dem/io/vtk_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace dem::io {

/// A ParaView collection: which file shows which part (grains, bodies, ...) at which time. The .pvd file is rewritten,
/// complete or not at all, at every add(), so that an interrupted run leaves a series that opens.
///
/// An older collection of that name stays until the first add(), or until a state is loaded: a load that is refused
/// leaves it. Its frames are replaced one by one; those of a part that an earlier run numbered higher than the first
/// frame which is added are removed then.
///
///     VtkSeries series("out/shear.pvd");                  // files go to out/shear/
///     const auto file = series.next_path("grains");       // out/shear/grains_000000.vtp
///     write_vtk_points(file, positions, {{"radius", 1, radii}});
///     series.add(t, file, "grains");
class VtkSeries {
 public:
  /// Writes an empty collection where there is none. Throws dem::Error when it cannot be written or the name does not
  /// end in ".pvd".
  explicit VtkSeries(std::filesystem::path pvd) : pvd_(std::move(pvd)) {
    if (pvd_.extension() != ".pvd") {
      fail("vtk series '{}': ParaView knows a collection by its ending; name it '{}.pvd'", pvd_.string(),
           pvd_.stem().string());
    }
    std::error_code ignored;
    if (!std::filesystem::exists(pvd_, ignored)) save();
  }

  /// Where the next file of `part` may be written, the same until add(): a folder beside the collection, with the
  /// collection's name, and files numbered from 0 for each part. Throws dem::Error for a part name with anything but
  /// letters, digits, _ and -.
  [[nodiscard]] std::filesystem::path next_path(std::string_view part) const {
    const auto allowed = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    if (part.empty() || !std::all_of(part.begin(), part.end(), allowed)) {
      fail("vtk series '{}': '{}' cannot name files; use letters, digits, _ and -", pvd_.string(), part);
    }
    const auto known = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return p.name == part; });
    const std::size_t count = known == parts_.end() ? 0 : known->files;
    return folder() / fmt::format("{}_{:06}.vtp", part, count);
  }

  /// Adds a file (which should be complete) that shows `part` at the time `time_s` [s]. The same time may be given for
  /// several parts; times of a part need not be equally spaced. A file of another folder may show several times, as a
  /// part does that stands still. Throws dem::Error when the time is not finite or before that of the part's last file,
  /// when a numbered file comes twice, and when the collection cannot be written.
  void add(double time_s, const std::filesystem::path& file, std::string_view part = "") {
    if (!std::isfinite(time_s)) {
      fail("vtk series '{}': the time of '{}' is {}; give a finite time", pvd_.string(), file.string(), time_s);
    }
    auto known = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return p.name == part; });
    // Relative to the collection, so that the whole folder can be moved.
    const std::string relative = file.lexically_proximate(pvd_.parent_path()).generic_string();
    const std::string shown = fmt::format("file=\"{}\"/>\n", escape_xml(relative));
    if (file.parent_path() == folder() && entries_.find(shown) != entries_.npos) {
      fail("vtk series '{}': '{}' is in it already; ask next_path() for each file", pvd_.string(), relative);
    }
    if (known == parts_.end()) {
      known = parts_.insert(parts_.end(), Part{std::string(part), 0});
    } else if (const auto last = last_time(known - parts_.begin()); last && time_s < *last) {
      fail("vtk series '{}': '{}' is of {} s, but part '{}' has one of {} s; add in the order of time", pvd_.string(),
           relative, time_s, part, *last);
    }
    remove_older(file, part, known->files);
    known->files += 1;
    entries_ += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" {}", time_s, known - parts_.begin(),
                            escape_xml(part), shown);
    save();
  }

  [[nodiscard]] const std::filesystem::path& path() const { return pvd_; }

  /// What is in the collection, to be kept and restored: a run that goes on adds to it.
  template <class V>
  void fields(V& v) {
    v("entries", entries_), v("parts", parts_);
    if (v.task() == V::Task::restore) save();
  }

 private:
  struct Part {
    std::string name;
    std::size_t files;
    template <class V>
    void fields(V& v) {
      v("name", name), v("files", files);
    }
  };

  [[nodiscard]] std::filesystem::path folder() const { return pvd_.parent_path() / pvd_.stem(); }

  /// Of the last file of a part (s): nothing where there is none.
  [[nodiscard]] std::optional<double> last_time(std::ptrdiff_t part) const {
    const auto at = entries_.rfind(fmt::format("\" part=\"{}\" name=\"", part));
    if (at == entries_.npos) return {};
    double time = 0.0;
    std::from_chars(entries_.data() + entries_.rfind('"', at - 1) + 1, entries_.data() + at, time);
    return time;
  }

  /// Removes what an earlier run wrote of a part, numbered higher than `number`, once, when this run's first numbered
  /// `file` of it is there. Files that this run did not write make no series that begins anew: all stay.
  void remove_older(const std::filesystem::path& file, std::string_view part, std::size_t number) {
    namespace fs = std::filesystem;
    if (!process_writes_files || std::find(cleared_.begin(), cleared_.end(), part) != cleared_.end()) return;
    if (file.filename() != fmt::format("{}_{:06}.vtp", part, number) || file.parent_path() != folder()) return;
    cleared_.emplace_back(part);
    std::error_code error;
    const auto is_older = [&](const fs::path& of) { return fs::last_write_time(of, error) < begun_; };
    if (is_older(file) || error) return;
    std::vector<fs::path> older;
    for (fs::directory_iterator entry(folder(), error), end; !error && entry != end; entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      if (name.size() < part.size() + 11 || !name.starts_with(part) || !name.ends_with(".vtp")) continue;
      const std::string_view digits = std::string_view(name).substr(part.size(), name.size() - part.size() - 4);
      std::size_t of = 0;
      const auto [stop, problem] = std::from_chars(digits.data() + 1, digits.data() + digits.size(), of);
      if (digits[0] != '_' || stop != digits.data() + digits.size() || problem != std::errc()) continue;
      if (of > number && entry->is_regular_file(error) && is_older(entry->path()) && !error) {
        older.push_back(entry->path());
      }
    }
    for (const fs::path& of : older) fs::remove(of, error);
  }

  void save() const {
    write_file(pvd_, fmt::format("<?xml version=\"1.0\"?>\n"
                                 "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"{}\">\n"
                                 "<Collection>\n{}</Collection>\n</VTKFile>\n",
                                 detail::kVtkByteOrder, entries_));
  }

  std::filesystem::path pvd_;
  std::vector<Part> parts_;  // in order of their first file; the position is ParaView's part number
  std::string entries_;
  std::vector<std::string> cleared_;  // parts that older files were removed of
  // What was written before is of an earlier run. File systems tell times a little late.
  std::filesystem::file_time_type begun_ =
      std::filesystem::file_time_type::clock::now() - std::chrono::milliseconds(50);
};

}  // namespace dem::io
