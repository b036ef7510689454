#pragma once

#include <dem/core/ids.hpp>
#include <dem/io/checkpoint/field_columns.hpp>
#include <dem/math/vector.hpp>
#include <dem/math/wrench.hpp>

#include <array>
#include <optional>
#include <type_traits>
#include <utility>

namespace dem::io {

namespace detail {
struct NoWords {
  template <class Item>
  const char* operator()(const Item&) const {
    return "";
  }
};
}  // namespace detail

/// Goes through the fields of a state, which names them once: to collect them in columns, to compare what a program
/// sets up with what it set up when the columns were collected, and to restore the state from them.
///
/// A struct with a state has one member function, of which this class is the argument:
///
///     template <class V>
///     void fields(V& v) {
///       v.given("name", name);                // set up by the program: compared, never restored
///       v("speed", speed, "m/s");             // state: restored
///     }
///
/// Fields may be numbers, bools, enums, ids, texts, vectors and matrices, wrenches, structs with fields of their own,
/// and std::vector, std::array, std::optional and std::pair of them. A field of a part in a list is a column with a row
/// a part.
class Fields : public FieldColumns {
 public:
  using FieldColumns::FieldColumns;

  /// A field of the state.
  template <class T>
  void operator()(std::string_view name, T& x, const char* unit = "") {
    if (task_ == Task::compare && !has_given<T>) return;
    const Inside inside(*this, name);
    visit(x, unit);
  }
  /// A field of the set-up.
  template <class T>
  void given(std::string_view name, const T& x, const char* unit = "") {
    if (task_ == Task::restore) return;
    const Inside inside(*this, name);
    T copy = x;
    visit(copy, unit);
  }
  /// What tells a part's geometry apart (fingerprint_of): compared, never restored.
  void fingerprint(std::string_view name, std::uint64_t bits) {
    if (task_ == Task::restore) return;
    const Inside inside(*this, name);
    if (task_ == Task::collect) exchange(ColumnKind::natural, 1, &bits, "");
    else compare_fingerprint(bits);
  }
  /// A list of parts that the program sets up: their number is compared. A difference is told of `one` with the name
  /// that it has as its first field, or its number. `more(item)` is what else the text says of it.
  template <class Items, class More = detail::NoWords>
  void list(std::string_view name, Items& items, const char* one, More&& more = {}) {
    const Inside inside(*this, name);
    if (task_ == Task::compare) compare_count(items.size(), one);
    if (task_ == Task::collect) add_count(items.size());
    const std::string outer = part_;
    for (std::size_t k = 0; k < items.size(); ++k) {
      begin_item(outer, one, k);
      if (task_ == Task::compare) part_ += more(items[k]);
      if constexpr (has_given<std::remove_reference_t<decltype(items[k])>>) visit(items[k], "");
      else given("name", items[k]);
    }
    part_ = outer;
  }
  /// The doubles that a struct of nothing but doubles consists of, as those of laws are.
  template <class Struct>
  void reals(std::string_view name, Struct& x, const char* unit = "") {
    if constexpr (!std::is_empty_v<Struct>) {
      static_assert(std::is_trivially_copyable_v<Struct> && sizeof(Struct) % sizeof(double) == 0);
      if (task_ == Task::compare) return;
      const Inside inside(*this, name);
      exchange(ColumnKind::real, sizeof(Struct) / sizeof(double), &x, unit);
    }
  }
  /// The same of the set-up; a difference is told by `Struct::names`, if there are any.
  template <class Struct>
  void given_reals(std::string_view name, const Struct& x) {
    if constexpr (!std::is_empty_v<Struct>) {
      if (task_ == Task::restore) return;
      constexpr std::size_t width = sizeof(Struct) / sizeof(double);
      const Inside inside(*this, name);
      Struct copy = x;
      if (task_ == Task::collect) return exchange(ColumnKind::real, width, &copy, "");
      const char* const* names = nullptr;
      if constexpr (requires { Struct::names[0]; }) {
        static_assert(std::size(Struct::names) == width, "names: one for each number of the struct");
        names = Struct::names;
      }
      compare_reals(width, reinterpret_cast<const double*>(&copy), names);
    }
  }
  /// n rows of `width` numbers that stay where they are while the columns are in use; to be restored they must have
  /// room.
  void rows(std::string_view name, ColumnKind kind, std::size_t width, void* data, std::size_t n,
            const char* unit = "") {
    if (task_ == Task::compare) return;
    const Inside inside(*this, name);
    const std::size_t bytes = n * width * size_of(kind);
    if (task_ == Task::restore) {
      take(kind, width, data, n);
    } else {
      Column& c = columns_->try_emplace(path_).first->second;
      c = {.kind = kind, .width = width, .unit = unit};
      if (n > 0) c.borrowed = {static_cast<const std::byte*>(data), bytes};
    }
  }
  /// Rows of `width` numbers that the columns keep a copy of; to be restored `numbers` take the size that is needed.
  template <class T>
  void copied(std::string_view name, ColumnKind kind, std::size_t width, std::vector<T>& numbers,
              const char* unit = "") {
    if (task_ == Task::compare) return;
    const Inside inside(*this, name);
    if (task_ == Task::restore) {
      numbers.resize(column().rows() * width);
      return take(kind, width, numbers.data(), numbers.size() / width);
    }
    const auto* from = reinterpret_cast<const std::byte*>(numbers.data());
    Column& c = columns_->try_emplace(path_).first->second;
    c = {.kind = kind, .width = width, .unit = unit};
    c.own.assign(from, from + numbers.size() * sizeof(T));
  }
  /// A list of structs of nothing but doubles, as samples are: a row each. Unlike copied(), of a part in a list too.
  template <class Struct>
  void numbers(std::string_view name, std::vector<Struct>& rows) {
    static_assert(sizeof(Struct) % sizeof(double) == 0 && alignof(Struct) == alignof(double));
    packed(name, ColumnKind::real, rows);
  }
  /// A list of structs of plain numbers, as their bytes are in memory.
  template <class Struct>
  void bytes(std::string_view name, std::vector<Struct>& rows) {
    packed(name, ColumnKind::byte, rows);
  }
  /// A group of fields: `f()` names them.
  template <class F>
  void group(std::string_view name, F&& f) {
    const Inside inside(*this, name);
    f();
  }
  /// Fields that a difference is told of in these words: `f()` names them.
  template <class F>
  void about(const std::string& words, F&& f) {
    const std::string outer = std::exchange(part_, words);
    f();
    part_ = outer;
  }

 private:
  template <class T>
  static constexpr bool has_given = requires(T& x, Fields& f) {
    x.fields(f);
  };

  template <class T>
  void visit(T& x, const char* unit) {
    if constexpr (has_given<T>) {
      x.fields(*this);
    } else if constexpr (std::is_same_v<T, double>) {
      exchange(ColumnKind::real, 1, &x, unit);
    } else if constexpr (std::is_enum_v<T> || (std::is_integral_v<T> && std::is_signed_v<T>)) {
      auto value = static_cast<std::int64_t>(x);
      exchange(ColumnKind::integer, 1, &value, unit);
      x = static_cast<T>(value);
    } else if constexpr (std::is_same_v<T, bool>) {
      auto value = static_cast<std::uint8_t>(x);
      exchange(ColumnKind::byte, 1, &value, unit);
      x = value != 0;
    } else if constexpr (std::is_integral_v<T>) {
      auto value = static_cast<std::uint64_t>(x);
      exchange(ColumnKind::natural, 1, &value, unit);
      x = static_cast<T>(value);
    } else if constexpr (requires {
                           x.data();
                           x.size();
                           T::RowsAtCompileTime;
                         }) {
      exchange(ColumnKind::real, static_cast<std::size_t>(T::RowsAtCompileTime * T::ColsAtCompileTime), x.data(), unit);
    } else {
      visit_more(x, unit);
    }
  }
  void visit_more(Vector3<double>& x, const char* unit) { exchange(ColumnKind::real, 3, &x, unit); }
  void visit_more(Matrix3<double>& x, const char* unit) { exchange(ColumnKind::real, 9, &x, unit); }
  void visit_more(Wrench& x, const char* unit) { exchange(ColumnKind::real, 6, &x, unit); }
  void visit_more(std::string& x, const char*) { exchange(ColumnKind::text, 1, &x, ""); }
  template <class Tag>
  void visit_more(Id<Tag>& x, const char* unit) {
    exchange(ColumnKind::natural32, 1, &x.value, unit);
  }
  void visit_more(GrainId& x, const char* unit) { exchange(ColumnKind::natural32, 2, &x.value, unit); }
  template <class T>
  void visit_more(std::optional<T>& x, const char* unit) {
    bool has = x.has_value();
    T value{};
    if constexpr (requires { T::RowsAtCompileTime; }) value.setZero();  // of which T{} leaves the numbers open
    if (has) value = *x;
    part_of("is_set", has, "");
    part_of("value", value, unit);
    if (has) x = value;
    else x.reset();
  }
  template <class A, class B>
  void visit_more(std::pair<A, B>& x, const char* unit) {
    part_of("first", x.first, unit);
    part_of("second", x.second, unit);
  }
  template <class T, std::size_t N>
  void visit_more(std::array<T, N>& x, const char* unit) {
    for (T& item : x) visit(item, unit);
  }
  template <class T, class Allocator>
  void visit_more(std::vector<T, Allocator>& x, const char* unit) {
    std::uint64_t count = x.size();
    part_of("count", count, "");
    x.resize(count);
    for (T& item : x) part_of("value", item, unit);
  }
  template <class Struct>
  void packed(std::string_view name, ColumnKind kind, std::vector<Struct>& rows) {
    static_assert(std::is_trivially_copyable_v<Struct>);
    if (task_ == Task::compare) return;
    const Inside inside(*this, name);
    const std::size_t width = sizeof(Struct) / size_of(kind);
    std::uint64_t count = rows.size();
    part_of("count", count, "");
    rows.resize(count);
    const Inside values(*this, "rows");
    if (task_ == Task::restore) return take(kind, width, rows.data(), count);
    Column& c = columns_->try_emplace(path_, Column{.kind = kind, .width = width}).first->second;
    const auto* from = reinterpret_cast<const std::byte*>(rows.data());
    c.own.insert(c.own.end(), from, from + count * sizeof(Struct));
  }
  template <class T>
  void part_of(std::string_view name, T& x, const char* unit) {
    const Inside inside(*this, name);
    visit(x, unit);
  }
};

}  // namespace dem::io
