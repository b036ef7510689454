#pragma once

#include <dem/core/macros.hpp>
#include <dem/io/checkpoint/columns.hpp>

#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

namespace dem::io {

namespace detail {

/// A row of a column in words.
DEM_SETUP inline std::string in_words(ColumnKind kind, std::size_t width, const void* data, const std::string& unit) {
  if (kind == ColumnKind::text) return "'" + *static_cast<const std::string*>(data) + "'";
  std::string words;
  for (std::size_t k = 0; k < width; ++k) {
    const char* at = static_cast<const char*>(data) + k * size_of(kind);
    const auto number = [&]<class T>(T x) {
      std::memcpy(&x, at, sizeof(x));
      return x;
    };
    if (k > 0) words += ", ";
    switch (kind) {
      case ColumnKind::real: {
        const double x = number(0.0);
        const std::string few = text("{:g}", x);
        double same = 0.0;
        std::from_chars(few.data(), few.data() + few.size(), same);
        words += same == x ? few : text("{:.17g}", x);
        break;
      }
      case ColumnKind::integer: words += std::to_string(number(std::int64_t{})); break;
      case ColumnKind::natural: words += std::to_string(number(std::uint64_t{})); break;
      case ColumnKind::natural32: words += std::to_string(number(std::uint32_t{})); break;
      case ColumnKind::byte: words += number(std::uint8_t{}) != 0 ? "yes" : "no"; break;
      case ColumnKind::text: break;
    }
  }
  if (width > 1) words = "(" + words + ")";
  return unit.empty() ? words : words + " " + unit;
}

/// The last part of a column's name, as a word.
DEM_SETUP inline std::string last_word(const std::string& path) {
  std::string word = path.substr(path.rfind('/') + 1);
  if (word == "value" || word == "count" || word == "is_set" || word == "first" || word == "second") {
    const std::size_t end = path.rfind('/');
    const std::size_t start = end == std::string::npos || end == 0 ? std::string::npos : path.rfind('/', end - 1);
    word = path.substr(start + 1, end - start - 1) + " (" + word + ")";
  }
  for (char& c : word) c = c == '_' ? ' ' : c;
  return word;
}

}  // namespace detail

/// The columns that Fields goes through, field by field: what of it does not depend on types.
class FieldColumns {
 public:
  enum class Task { collect, compare, restore };

  /// Columns to be restored have to be compared first.
  FieldColumns(Task task, StateColumns& columns) : task_(task), columns_(&columns) {
    if (task == Task::collect) columns.clear();
    if (task != Task::compare) return;
    for (auto& [name, column] : columns) column.at = 0;
  }
  Task task() const { return task_; }
  /// Throws Error if there is a column that was not read to its end, of those whose names begin with `group`: a state
  /// that this program does not have.
  void check_all_read(std::string_view group = "") const;

 protected:
  /// While it lives, fields are those of a group of this name.
  struct Inside {
    Inside(FieldColumns& f, std::string_view name) : fields(f), length(f.path_.size()) {
      if (name.empty()) return;
      if (length > 0) f.path_ += '/';
      f.path_ += name;
    }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    ~Inside() { fields.path_.resize(length); }
    FieldColumns& fields;
    std::size_t length;
  };

  /// The column of the present field.
  Column& column();
  /// One row of it, the way that the task says.
  void exchange(ColumnKind kind, std::size_t width, void* data, const char* unit);
  /// Its next n rows.
  void take(ColumnKind kind, std::size_t width, void* data, std::size_t n);
  void compare(const Column& c, const void* data);
  void compare_count(std::size_t count, const char* one);
  void compare_fingerprint(std::uint64_t bits);
  /// A row of numbers of the set-up, which may have names.
  void compare_reals(std::size_t width, const double* numbers, const char* const* names);
  void add_count(std::size_t count);
  /// From here on fields are those of item k of a list, in words `one`; `outer` is whose list it is.
  void begin_item(const std::string& outer, const char* one, std::size_t k);

  Task task_;
  StateColumns* columns_;
  std::string path_;  ///< of the present field
  std::string part_;  ///< in words, whose fields they are
  std::string kind_of_part_;
  bool named_ = true;  ///< whether the present part has been named
};

DEM_SETUP inline Column& FieldColumns::column() {
  const auto found = columns_->find(path_);
  if (found == columns_->end()) {
    fail(
        "the saved state has no '{}', which this program reads; load with the Model of the program that saved it, and "
        "give load what save was given besides the world",
        path_);
  }
  return found->second;
}

inline void FieldColumns::take(ColumnKind kind, std::size_t width, void* data, std::size_t n) {
  Column& c = column();
  if (c.kind != kind || c.width != width || c.at + n > c.rows()) {
    fail(
        "'{}' of the saved state has {} rows of {} numbers, but this program reads {} of {}; load with the Model of "
        "the "
        "program that saved it, and give load what save was given besides the world",
        path_, c.rows(), c.width, c.at + n, width);
  }
  if (kind == ColumnKind::text) {
    for (std::size_t k = 0; k < n; ++k) static_cast<std::string*>(data)[k] = c.texts[c.at + k];
  } else if (n > 0) {
    std::memcpy(data, c.bytes().data() + c.at * c.row_bytes(), n * c.row_bytes());
  }
  c.at += n;
}

inline void FieldColumns::exchange(ColumnKind kind, std::size_t width, void* data, const char* unit) {
  if (task_ == Task::restore) return take(kind, width, data, 1);
  if (task_ == Task::collect) {
    Column& c = columns_->try_emplace(path_, Column{.kind = kind, .width = width, .unit = unit}).first->second;
    DEM_ASSERT(c.kind == kind && c.width == width, "all rows of a column are alike");
    if (kind == ColumnKind::text) {
      c.texts.push_back(*static_cast<std::string*>(data));
    } else {
      const auto* from = static_cast<const std::byte*>(data);
      c.own.insert(c.own.end(), from, from + c.row_bytes());
    }
    return;
  }
  if (!named_) {  // the first field of a part is its name, if it is a text
    named_ = true;
    if (kind == ColumnKind::text) {
      const std::size_t start = part_.rfind(kind_of_part_);
      part_ = part_.substr(0, start) + kind_of_part_ + " '" + *static_cast<std::string*>(data) + "'";
    }
  }
  Column& c = column();
  const std::size_t at = c.at;
  if (c.kind != kind || c.width != width || at >= c.rows()) {
    fail("{}{} is of another kind in the saved state; set it up as the program did that saved it",
         part_.empty() ? "" : part_ + ": ", detail::last_word(path_));
  }
  compare(c, data);
  c.at = at + 1;
}

DEM_SETUP inline void FieldColumns::compare(const Column& c, const void* data) {
  const void* saved = c.kind == ColumnKind::text ? static_cast<const void*>(&c.texts[c.at])
                                                 : static_cast<const void*>(c.bytes().data() + c.at * c.row_bytes());
  const bool same = c.kind == ColumnKind::text ? c.texts[c.at] == *static_cast<const std::string*>(data)
                                               : std::memcmp(saved, data, c.row_bytes()) == 0;
  if (same) return;
  fail("{}{} is {} in the saved state, but {} in this program; set it up as the program did that saved it",
       part_.empty() ? "" : part_ + ": ", detail::last_word(path_), detail::in_words(c.kind, c.width, saved, c.unit),
       detail::in_words(c.kind, c.width, data, c.unit));
}

DEM_SETUP inline void FieldColumns::compare_fingerprint(std::uint64_t bits) {
  std::uint64_t saved = 0;
  take(ColumnKind::natural, 1, &saved, 1);
  if (saved == bits) return;
  fail("{}its {} in this program differs from that in the saved state; set it up as the program did that saved it",
       part_.empty() ? "" : part_ + ": ", detail::last_word(path_));
}

DEM_SETUP inline void FieldColumns::compare_reals(std::size_t width, const double* numbers, const char* const* names) {
  std::vector<double> saved(width);
  take(ColumnKind::real, width, saved.data(), 1);
  for (std::size_t k = 0; k < width; ++k) {
    if (std::memcmp(&saved[k], &numbers[k], sizeof(double)) == 0) continue;
    fail("{}{}{} is {} in the saved state, but {} in this program; set it up as the program did that saved it",
         part_.empty() ? "" : part_ + ": ", detail::last_word(path_),
         names ? std::string(".") + names[k] : text(", number {} of {},", k + 1, width),
         detail::in_words(ColumnKind::real, 1, &saved[k], ""), detail::in_words(ColumnKind::real, 1, &numbers[k], ""));
  }
}

DEM_SETUP inline void FieldColumns::add_count(std::size_t count) {
  const Inside inside(*this, "count");
  std::uint64_t n = count;
  exchange(ColumnKind::natural, 1, &n, "");
}

DEM_SETUP inline void FieldColumns::compare_count(std::size_t count, const char* one) {
  std::uint64_t saved = 0;
  const Inside inside(*this, "count");
  take(ColumnKind::natural, 1, &saved, 1);
  if (saved == count) return;
  std::string names;
  const std::string list = path_.substr(0, path_.rfind('/'));
  if (const auto c = columns_->find(list + "/name"); c != columns_->end()) {
    for (const std::string& name : c->second.texts) names += (names.empty() ? " ('" : ", '") + name + "'";
    if (!names.empty()) names += ")";
  }
  fail("{}{}: the saved state has {}{}, but this program has {}; set it up as the program did that saved it",
       part_.empty() ? "" : part_ + ", ", one, saved, names, count);
}

DEM_SETUP inline void FieldColumns::begin_item(const std::string& outer, const char* one, std::size_t k) {
  part_ = (outer.empty() ? "" : outer + ", ") + one + " " + std::to_string(k);
  named_ = false;
  kind_of_part_ = one;
}

DEM_SETUP inline void FieldColumns::check_all_read(std::string_view group) const {
  for (const auto& [name, column] : *columns_) {
    if (column.at == column.rows() || !name.starts_with(group)) continue;
    if (group == "model/" && !column.texts.empty()) {
      fail("the model that was saved has {} = {}, and this program's has the default; name the same in its Model",
           detail::last_word(name), column.texts[0]);
    }
    fail(
        "the saved state has '{}', which this program does not read; load with the Model of the program that saved it, "
        "and give load what save was given besides the world",
        name);
  }
}

}  // namespace dem::io
