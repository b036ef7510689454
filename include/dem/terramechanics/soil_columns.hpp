#pragma once

#include <dem/parallel/threads.hpp>
#include <dem/terramechanics/bulldozing.hpp>
#include <dem/terramechanics/column_force.hpp>
#include <dem/terramechanics/column_memory.hpp>
#include <dem/terramechanics/columns_spec.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace dem::terramechanics {

/// Soil as a field of columns with memory: the dynamic Bekker method (thesis section 1.2.2). Each column follows the
/// pressure law when it is pressed deeper than ever, springs back along a straight line, keeps its rut, and remembers
/// how far it was sheared. Machine parts of any shape press on it; the lowest part over a column has it.
///
///     SoilColumns soil({.length_x = 2, .length_y = 1, .spacing = 0.01, .soil = melanz_sand});
///     soil.apply(parts, dt);  // parts: where they are and how they move now
///     soil.loads()[0].force;  // what the first one feels
///
/// The width b of the pressure law is a constant of each part, not taken from the columns that it happens to touch, and
/// columns at an edge count with the share under the part: so forces do not depend on the grid, but for its error.
/// Shear is counted by soil, not by rim: a column below a wheel was slid over 1/(1 - s) cos(theta) times the way that
/// eq. 11 has for the rim there. Walls that stand upright feel nothing: blades are not pushed, and grousers leave
/// prints but do not pull; take a cylinder of the radius at which the soil shears off for their thrust. Forces are
/// summed column by column in the order of the rows, so results are the same bits for any number of threads.
class SoilColumns {
 public:
  /// Throws Error, in words, for a field that cannot be (check_columns).
  explicit SoilColumns(const ColumnsSpec& spec) : spec_((check_columns(spec), spec)) {
    ColumnGrid& g = field_.grid;
    const auto count = [&](double length) {
      return static_cast<std::size_t>(std::ceil(length / spec.spacing * (1.0 - 1e-9)));
    };
    g = {spec.low_x, spec.low_y, spec.spacing, count(spec.length_x), count(spec.length_y)};
    field_.resize(spec.height);
    claim_.assign(g.size(), free);
    claim_height_.assign(g.size(), 0.0);
    top_ = spec.height;
    soils_ = {spec.soil};
    bulldozing_.share = spec.bulldozing;
    bulldozing_.steepest = std::tan(spec.angle_of_repose);
    threads_.set_threads(1);
  }

  /// Threads that share the rows of columns; 1 unless set. Worth it from some thousand columns under a machine.
  void set_threads(int n) { threads_.set_threads(n); }

  /// Gives the untouched soil a surface: height(x, y) in m. Throws Error if a height is not finite.
  template <class F>
  void shape_ground(F&& height) {
    top_ = field_.shape(height);
  }

  /// Lays other soils beside that of the spec, which is number 0: which(x, y) says the number of the soil at a place
  /// (m), 1 for the first of `others`. To be called before anything presses. Throws Error for soils that cannot be, or
  /// numbers that no soil has.
  template <class F>
  void lay_soils(std::span<const Soil> others, F&& which) {
    if (others.size() > 254) fail("{} soils are to be laid, but at most 254 can be", others.size());
    for (const Soil& other : others) check_soil(other);
    field_.lay(others.size(), which);
    soils_.resize(1);
    soils_.insert(soils_.end(), others.begin(), others.end());
  }
  const std::vector<Soil>& soils() const { return soils_; }

  /// A step of dt (s): the loads on the parts where they are now, and what the columns keep of it. Never throws for
  /// what happens while running; a part that is not fit to be used (no shape, no width) throws Error.
  ColumnsReport apply(std::span<const ColumnPart> parts, double dt) {
    ColumnsReport report = evaluate(parts, dt);
    commit();
    return report;
  }

  /// The loads of a step of dt (s) on from the last one that was kept, without keeping it: for integrators that look at
  /// a step more than once.
  ColumnsReport evaluate(std::span<const ColumnPart> parts, double dt);
  /// Keeps what the last evaluation found.
  void commit();

  /// What each part felt in the last evaluation, in their order.
  const std::vector<ColumnLoad>& loads() const { return loads_; }
  const ColumnField& field() const { return field_; }
  const ColumnsSpec& spec() const { return spec_; }
  double top() const { return top_; }  ///< m, no column is higher
  /// Steps that were kept.
  std::uint32_t steps() const { return step_; }

  /// Appends all that the columns remember, for a saved state; restore() takes it back from a place in `numbers` on.
  /// Throws Error if they are not those of so many columns.
  void collect(std::vector<double>& numbers) const { ColumnMemory::collect(field_, {step_, top_, margin()}, numbers); }
  void restore(std::span<const double> numbers) {
    const ColumnMemory::Rest rest = ColumnMemory::restore(field_, numbers);
    step_ = rest.step;
    top_ = rest.top;
    bulldozing_.set_margin(rest.margin);
    strip_count_ = 0;
  }

 private:
  static constexpr std::int32_t free = -1;

  struct Hit {
    std::size_t row;
    ColumnContactPoint contact;
  };
  /// A row of columns under a part: the unit of work for threads and of sums.
  struct Strip {
    std::int32_t part, owner;  ///< the owner is the part that this one goes on with, or itself
    std::size_t iy, from, to;
    std::vector<Hit> hits;
    std::vector<ColumnChange> changes;
    ColumnLoad load;
  };

  void take(std::span<const ColumnPart> parts);
  void add_strips(const ColumnPart& part, std::int32_t number, ColumnsReport& report);
  bool lay_out(std::span<const ColumnPart> parts, ColumnsReport& report);
  void look(const ColumnPart& part, Strip& strip) const;
  void claim(std::size_t parts);
  void press(const ColumnPart& part, double dt, bool shared, Strip& strip) const;
  std::size_t margin() const { return bulldozing_.margin(); }

  ColumnsSpec spec_;
  ColumnField field_;
  Bulldozing bulldozing_;
  exec::Threads threads_;
  double top_ = 0.0;  ///< m, no column is higher
  std::uint32_t step_ = 0;
  std::vector<Strip> strips_;
  std::size_t strip_count_ = 0;
  std::vector<Soil> soils_;
  std::vector<ColumnLaw> laws_;  ///< of the parts: for each one after the other soil
  std::vector<double> slopes_;   ///< tangents of the soils' angles of friction
  std::vector<ColumnLoad> loads_;
  std::vector<Vector3<double>> velocity_;  ///< of the parts' bodies
  std::vector<std::int32_t> claim_;        ///< the part that has a column, while an evaluation runs
  std::vector<double> claim_height_;
  std::vector<std::size_t> rows_;
};

/// The laws of the soils under the parts, and the parts' velocities.
inline void SoilColumns::take(std::span<const ColumnPart> parts) {
  laws_.clear();
  slopes_.clear();
  for (const Soil& soil : soils_) slopes_.push_back(std::tan(soil.shear.friction_angle));
  velocity_.clear();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const ColumnPart& part = parts[p];
    if (!part.shape) fail("part {} on soil columns has no shape; give it one, such as a ColumnCylinder", p);
    const double width = part.width > 0.0 ? part.width : part.shape->width();
    if (!(width > 0.0)) {
      fail("part {} on soil columns has no width, which the pressure law asks for; set width to its smaller side", p);
    }
    for (const Soil& soil : soils_) laws_.emplace_back(soil, width, spec_.thickness);
    velocity_.push_back(part.body.velocity);
    if (part.continues < 0) continue;
    if (part.continues >= static_cast<std::int32_t>(p))
      fail("part {} on soil columns goes on with part {}, but can only with one before it", p, part.continues);
    // The mean of the pieces: a tread turns about its axle.
    const auto owner = static_cast<std::size_t>(part.continues);
    const double pieces = static_cast<double>(p - owner) + 1.0;
    velocity_[owner] += (1.0 / pieces) * (part.body.velocity - velocity_[owner]);
  }
}

/// The strips of columns that may be under a part. What of it is not over the field is told of.
inline void SoilColumns::add_strips(const ColumnPart& part, std::int32_t number, ColumnsReport& report) {
  const ColumnGrid& g = field_.grid;
  const PlanBox box = part.shape->shadow(part.pose(), top_);
  if (box.empty()) return;
  if (!g.holds(box)) {
    loads_[static_cast<std::size_t>(number)].leaves = true;
    report.ok = false;
    report.part = number;
    report.text = leaving_in_words(fmt::format("part {} on soil columns", number), part, g);
    if (!g.meets(box)) return;
  }
  const ColumnRange under = g.around(box);
  for (std::size_t iy = under.from_y; iy <= under.to_y; ++iy) {
    if (strip_count_ == strips_.size()) strips_.emplace_back();
    Strip& s = strips_[strip_count_++];
    s.part = number;
    s.owner = part.continues >= 0 ? part.continues : number;
    s.iy = iy;
    s.from = under.from_x;
    s.to = under.to_x;
  }
}

/// Strips of columns that may be under the parts. False if nothing can be computed.
inline bool SoilColumns::lay_out(std::span<const ColumnPart> parts, ColumnsReport& report) {
  strip_count_ = 0;
  loads_.assign(parts.size(), {});
  take(parts);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].is_somewhere()) {
      report.ok = false;
      report.part = static_cast<std::int32_t>(p);
      report.text = fmt::format(
          "part {} on soil columns is nowhere: its position or velocity is not finite, or its rotation is none; lower "
          "the time step",
          p);
      return false;
    }
    add_strips(parts[p], static_cast<std::int32_t>(p), report);
  }
  return true;
}

/// What of a strip lies under its part, ascending.
inline void SoilColumns::look(const ColumnPart& part, Strip& s) const {
  const ColumnGrid& g = field_.grid;
  const ShapePose pose = part.pose();
  s.hits.clear();
  for (std::size_t ix = s.from; ix <= s.to; ++ix) {
    Hit hit{g.row(ix, s.iy), {}};
    const double top = field_.resting(hit.row);
    if (part.shape->column_contact(pose, g.place(ix, s.iy), top, hit.contact)) s.hits.push_back(hit);
  }
}

/// Where several parts are over a column the lowest one has it; of two at one height the first.
inline void SoilColumns::claim(std::size_t parts) {
  if (parts < 2) return;
  for (std::size_t k = 0; k < strip_count_; ++k) {
    for (const Hit& hit : strips_[k].hits) {
      if (claim_[hit.row] != free && claim_height_[hit.row] <= hit.contact.point.z) continue;
      claim_[hit.row] = strips_[k].part;
      claim_height_[hit.row] = hit.contact.point.z;
    }
  }
}

/// The forces of a strip, summed along it.
inline void SoilColumns::press(const ColumnPart& part, double dt, bool shared, Strip& s) const {
  const ColumnLaw* laws = &laws_[static_cast<std::size_t>(s.part) * soils_.size()];
  s.changes.clear();
  s.load = {};
  const Vector3<double> spin = part.body.rotation * part.body.angular_velocity;
  const Vector3<double> spun = part.before.rotation * part.before.angular_velocity;
  for (const Hit& hit : s.hits) {
    if (shared && claim_[hit.row] != s.part) continue;
    const Vector3<double> arm = hit.contact.point - part.body.position,
                          velocity = part.body.velocity + cross(spin, arm);
    Vector3<double> slid = velocity;
    if (part.newest_share < 1.0) {
      const Vector3<double> back = hit.contact.point - part.before.position;
      slid = part.newest_share * velocity + (1.0 - part.newest_share) * (part.before.velocity + cross(spun, back));
    }
    // A column that passes from one piece of a tread to the next is still in contact.
    const bool in_contact = step_ > 0 && field_.touched[hit.row] == step_ && field_.touched_by[hit.row] == s.owner;
    ColumnChange change{.row = hit.row, .part = s.owner, .shear = {}};
    const std::size_t kind = field_.soil.empty() ? 0 : field_.soil[hit.row];
    const PressedColumn column = {laws[kind],  soils_[kind].shear, slopes_[kind], part.friction, spec_.damping,
                                  hit.contact, velocity,           slid,          in_contact};
    const ColumnForce f = column_force(field_, column, dt, change);
    if (!f.acts) continue;
    s.changes.push_back(change);
    s.load.force += f.force;
    s.load.torque += cross(arm, f.force);
    s.load.stiffness += f.stiffness;
    s.load.area += field_.grid.area() * hit.contact.share;
    ++s.load.columns;
  }
}

inline ColumnsReport SoilColumns::evaluate(std::span<const ColumnPart> parts, double dt) {
  ColumnsReport report;
  if (!lay_out(parts, report)) {
    strip_count_ = 0;
    return report;
  }
  threads_.for_each(strip_count_,
                    [&](std::size_t k) { look(parts[static_cast<std::size_t>(strips_[k].part)], strips_[k]); });
  claim(parts.size());
  threads_.for_each(strip_count_, [&](std::size_t k) {
    const auto p = static_cast<std::size_t>(strips_[k].part);
    press(parts[p], dt, parts.size() > 1, strips_[k]);
  });
  for (std::size_t k = 0; k < strip_count_; ++k) {
    const Strip& s = strips_[k];
    ColumnLoad& load = loads_[static_cast<std::size_t>(s.part)];
    load.force += s.load.force;
    load.torque += s.load.torque;
    load.stiffness += s.load.stiffness;
    load.area += s.load.area;
    load.columns += s.load.columns;
    report.columns += s.load.columns;
    for (const ColumnChange& change : s.changes) report.on_base += change.on_base ? 1 : 0;
    for (const Hit& hit : s.hits) claim_[hit.row] = free;
  }
  return report;
}

inline void SoilColumns::commit() {
  ++step_;
  for (std::size_t k = 0; k < strip_count_; ++k) {
    for (const ColumnChange& c : strips_[k].changes) {
      field_.touched[c.row] = step_;
      field_.touched_by[c.row] = c.part;
    }
  }
  for (std::size_t k = 0; k < strip_count_;) {
    const std::int32_t owner = strips_[k].owner;
    double risen = 0.0;
    rows_.clear();
    for (; k < strip_count_ && strips_[k].owner == owner; ++k) {
      for (const ColumnChange& c : strips_[k].changes) {
        risen += c.sunk - field_.sunk[c.row];
        field_.ground[c.row] = field_.reference(c.row);  // loose soil is pressed in, or becomes soil like any other
        field_.heap[c.row] = 0.0;
        field_.deepest[c.row] = c.deepest;
        field_.modulus[c.row] = c.modulus;
        field_.sunk[c.row] = c.sunk;
        field_.pressure[c.row] = c.pressure;
        field_.shear[c.row] = c.shear;
        rows_.push_back(c.row);
      }
    }
    if (!(bulldozing_.share > 0.0) || rows_.empty()) continue;
    if (!std::is_sorted(rows_.begin(), rows_.end())) std::sort(rows_.begin(), rows_.end());  // of several pieces
    const Vector3<double>& v = velocity_[static_cast<std::size_t>(owner)];
    // What only sinks has no sides: rounding is no motion.
    const bool moves = v.x * v.x + v.y * v.y > 1e-4 * v.z * v.z;
    bulldozing_.deposit(field_, rows_, risen * field_.grid.area(), moves ? v.x : 0.0, moves ? v.y : 0.0, step_);
    top_ = std::max(top_, bulldozing_.roll(field_, rows_, step_));
  }
  strip_count_ = 0;
}

}  // namespace dem::terramechanics
