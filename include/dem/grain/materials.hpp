#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/law/cohesion/cohesion_law.hpp>
#include <dem/law/friction/friction_law.hpp>
#include <dem/law/normal/normal_law.hpp>
#include <dem/law/rolling/rolling_law.hpp>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dem {

/// The constants of a contact between two materials (T = double) or those of a pack of contacts.
template <class Model, class T = double>
struct ContactParameters {
  typename Model::Normal::template Parameters<T> normal;
  typename Model::Friction::template Parameters<T> friction;
  [[no_unique_address]] typename Model::Rolling::template Parameters<T> rolling = {};
  [[no_unique_address]] typename Model::Cohesion::template Parameters<T> cohesion = {};
  template <class V>
  void fields(V& v) {
    v.given_reals("normal", normal), v.given_reals("friction", friction);
    v.given_reals("rolling", rolling), v.given_reals("cohesion", cohesion);
  }
};

/// Materials by name, and which pair of them takes which row of a table of contact constants; row 0 is that of all
/// pairs that have none of their own.
class MaterialNames {
 public:
  DEM_VALUE(MaterialNames)

  /// The material of that name; made when it is new.
  MaterialId id(std::string_view name);
  /// Row of the table for a pair.
  std::uint32_t row(MaterialId a, MaterialId b) const { return entry_[a.index() * names_.size() + b.index()]; }
  const std::string& name(MaterialId m) const { return names_.at(m.index()); }
  std::size_t count() const { return names_.size(); }

  /// Notes that grains, not only machine parts, are made of this material.
  void mark_as_grain(MaterialId m);
  /// Throws Error if two materials that may meet (at least one of them of grains) have no constants.
  void check_complete() const;
  /// Throws Error if constants were given for a material that nothing is made of: a name that was misspelt. The names
  /// that grains and walls have by default may wait for them.
  void check_names(std::span<const MaterialId> used) const;
  /// Throws Error if the two materials have no constants.
  void check_pair(MaterialId a, MaterialId b) const;

 protected:
  struct Pair {
    MaterialId a, b;
    template <class V>
    void fields(V& v) {
      v.given("a", a), v.given("b", b);
    }
  };
  static constexpr std::uint32_t default_entry = 0;

  /// The row of a pair, which is a new one, the last, if it had none of its own.
  std::uint32_t own_row(std::string_view a, std::string_view b);
  std::uint32_t& entry(MaterialId a, MaterialId b) { return entry_[a.index() * names_.size() + b.index()]; }
  bool is_grain(std::size_t m) const { return m < grain_.size() && grain_[m]; }

  std::vector<std::string> names_;
  std::vector<Pair> pairs_;  // pairs_[k] has row k + 1
  std::vector<std::uint32_t> entry_;
  std::vector<bool> grain_;
  bool has_default_ = false;
};

/// The same with the table.
template <class Model>
class Materials : public MaterialNames {
 public:
  using Parameters = ContactParameters<Model>;

  /// Constants of every pair that has none of its own. Throws Error if one makes no sense.
  void set_default(const Parameters& p) {
    check(p);
    table_[default_entry] = p;
    has_default_ = true;
  }
  /// Constants of the pair a, b (and b, a). Throws Error if one makes no sense.
  void set(std::string_view a, std::string_view b, const Parameters& p) {
    const Parameters given = p;  // may be one of the table
    try {
      check(given);
    } catch (const Error& e) {
      fail("contact of '{}' and '{}': {}", a, b, e.what());
    }
    if (table_.size() == table_.capacity()) table_.reserve(2 * table_.size());  // first: it may throw
    const std::uint32_t row = own_row(a, b);
    if (row == table_.size()) table_.push_back(given);
    else table_[row] = given;
  }
  const std::vector<Parameters>& table() const { return table_; }

  /// The largest gap (m) at which partners of that effective radius or less may still act on each other: 0 unless the
  /// cohesion law acts at a distance. World finds it when it is prepared. Throws Error if the law tells a range that is
  /// negative or not finite.
  void find_range(double radius) {
    range_ = 0.0;
    if constexpr (cohesion::reaches<typename Model::Cohesion>) {
      for (const Parameters& p : table_) {
        if (&p == table_.data() && !has_default_) continue;
        const double range = Model::Cohesion::range(p.cohesion, radius);
        range_ = std::max(range_, require_non_negative(range, "range that a cohesion law tells", "m"));
      }
    }
  }
  double range() const { return range_; }

  template <class V>
  void fields(V& v) {
    v.list("names", names_, "material"), v.given("has_default", has_default_),
        v.list("pairs", pairs_, "pair of materials");
    for (std::size_t k = 0; k < table_.size(); ++k) {
      v.about(k == 0 ? "contact of all other materials"
                     : "contact of '" + name(pairs_[k - 1].a) + "' and '" + name(pairs_[k - 1].b) + "'",
              [&] { v("constants", table_[k]); });
    }
    v("range", range_, "m");
  }

 private:
  static void check(const Parameters& p) {
    Model::Normal::check(p.normal);
    Model::Friction::check(p.friction);
    Model::Rolling::check(p.rolling);
    Model::Cohesion::check(p.cohesion);
    cohesion::check_with_normal_law<typename Model::Cohesion>(p.cohesion, p.normal);
  }

  std::vector<Parameters> table_ = {Parameters{}};
  double range_ = 0.0;
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_DEFINE_VALUE(MaterialNames)

DEM_INLINE MaterialId MaterialNames::id(std::string_view name) {
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (names_[k] == name) return MaterialId(k);
  }
  names_.emplace_back(name);
  entry_.assign(names_.size() * names_.size(), default_entry);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    entry(pairs_[k].a, pairs_[k].b) = static_cast<std::uint32_t>(k + 1);
    entry(pairs_[k].b, pairs_[k].a) = static_cast<std::uint32_t>(k + 1);
  }
  return MaterialId(names_.size() - 1);
}

DEM_INLINE std::uint32_t MaterialNames::own_row(std::string_view a, std::string_view b) {
  const MaterialId ia = id(a), ib = id(b);
  if (const std::uint32_t known = entry(ia, ib); known != default_entry) return known;
  pairs_.push_back({ia, ib});
  return entry(ia, ib) = entry(ib, ia) = static_cast<std::uint32_t>(pairs_.size());
}

DEM_INLINE void MaterialNames::mark_as_grain(MaterialId m) {
  grain_.resize(std::max(grain_.size(), names_.size()), false);
  grain_[m.index()] = true;
}

DEM_INLINE void MaterialNames::check_complete() const {
  if (has_default_) return;
  for (std::size_t a = 0; a < names_.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      if (is_grain(a) || is_grain(b)) check_pair(MaterialId(b), MaterialId(a));
    }
  }
}

DEM_INLINE void MaterialNames::check_names(std::span<const MaterialId> used) const {
  const auto is_used = [&](MaterialId m) {
    return name(m) == "grain" || name(m) == "wall" || std::find(used.begin(), used.end(), m) != used.end();
  };
  for (const Pair& pair : pairs_) {
    for (const MaterialId m : std::initializer_list<MaterialId>{pair.a, pair.b}) {  // named for nvcc
      if (is_used(m)) continue;
      std::string known;
      for (const MaterialId u : used) {
        if (known.find("'" + name(u) + "'") == std::string::npos) known += dem::text(" '{}'", name(u));
      }
      fail(
          "contact constants were given for the material '{}', but no grain and no surface is made of it; there "
          "are:{}; correct the name, or add what it is for first",
          name(m), known);
    }
  }
}

DEM_INLINE void MaterialNames::check_pair(MaterialId a, MaterialId b) const {
  if (has_default_ || row(a, b) != default_entry) return;
  fail(
      "no contact constants for the materials '{}' and '{}'; call set_contact(\"{}\", \"{}\", ...), or "
      "set_contact(...) for all pairs",
      name(a), name(b), name(a), name(b));
}

}  // namespace dem

#endif
