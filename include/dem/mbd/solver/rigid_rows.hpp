#pragma once

// What is held exactly, as rows of one sparse system of equations: joints and couplings without a stiffness of their
// own, and prescribed motions. Each row is a direction in the space of all bodies' velocities, along which only what is
// prescribed may move. Joints that share a body stand near each other, so that the system stays narrow.

#include <dem/core/macros.hpp>
#include <dem/math/skyline.hpp>
#include <dem/mbd/drive/jacobian.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace dem::mbd::detail {

/// The rows of a machine, and the factors of J M^-1 J^T.
class RigidRows {
 public:
  struct Item {
    enum Kind : std::uint8_t { joint, coupling, drive } kind;
    std::uint32_t index;  ///< among the joints, the couplings, or Parts::rows
    std::uint32_t first_row = 0;
  };
  struct Side {
    std::uint32_t body, row;
    Wrench push;               ///< of a unit impulse, about the centre of mass, global
    Vector3<double> torque;    ///< of a unit impulse, body frame
    Vector3<double> velocity;  ///< m/s that it makes, global; 0 of a body that does not give way
    Vector3<double> spin;      ///< rad/s that it makes, body frame; likewise
  };

  std::size_t size() const { return rates_.size(); }
  const std::vector<Item>& items() const { return items_; }
  const std::vector<Side>& sides() const { return sides_; }
  const Item& item_of(std::uint32_t row) const { return items_[item_of_row_[row]]; }

  /// Whether a part was switched on or off since the rows were laid out.
  bool is_laid_out_for(const Parts& m) const { return key_ == key_of(m); }
  void lay_out(Parts& m);

  /// The rows and the factors at the present positions.
  void update(Parts& m);
  /// Turns changes of speed along the rows into the impulses that make them.
  void solve(std::vector<double>& x) const { matrix_.solve(x); }

  /// What the speeds along the rows lack.
  void speed_errors(const Parts& m, std::vector<double>& x) const;
  /// How far each row is off (m, rad), in the present pose. Returns the largest; m count by `per_metre`.
  double errors(Parts& m, std::vector<double>& x, double per_metre) const;

  static bool is_rigid(const Coupling& g) { return g.spec.on && !g.spec.stiffness && !g.spec.damping; }

 private:
  using V = Vector3<double>;

  /// Another number if another set of parts is held.
  static std::uint64_t key_of(const Parts& m);

  template <class F>
  static void for_each_body(const Parts& m, const Item& item, F&& each) {
    if (item.kind == Item::joint) {
      each(m.joints[item.index].a);
      each(m.joints[item.index].b);
    } else if (item.kind == Item::coupling) {
      for (const auto& term : m.couplings[item.index].spec.terms) {
        each(m.joints[term.joint.index()].a);
        each(m.joints[term.joint.index()].b);
      }
    } else {
      const JacobianRow& r = m.rows[item.index];
      if (r.a != JacobianRow::no_body) each(r.a);
      each(r.b);
    }
  }

  /// Cuthill and McKee's order, backwards: from an item with few neighbours outwards, neighbours with few first.
  void sort_items(const Parts& m);

  void fill(const Parts& m);
  /// A side of the row that is being made.
  void add_side(const Parts& m, std::uint32_t body, const Wrench& push);
  void add_joint(const Parts& m, const Joint& j);
  /// How far the joint is off along each of its rows, in their order: the rows are these errors' gradients.
  template <class F>
  static void for_each_error(const Joint& j, const Body& a, const Body& b, double per_metre, F&& put) {
    const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
    const V d = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
    const JointTraits& traits = traits_of(j.kind);
    if (traits.hold == Hold::length) {
      put(norm(d) - j.length, per_metre);
    } else {
      for_each_held_axis(j, traits.hold, [&](const V& axis) { put(dot(A * axis, d), per_metre); });
    }
    for_each_rotation_error(j, traits.align, A, B, [&](double error) { put(error, 1.0); });
  }

  std::vector<Item> items_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> item_of_row_;
  std::vector<double> rates_;  ///< wanted along each row, m/s or rad/s
  std::vector<std::vector<std::uint32_t>> on_body_;
  std::vector<char> gives_way_;
  std::uint64_t key_ = 0;
  Skyline matrix_;
};

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void RigidRows::lay_out(Parts& m) {
  key_ = key_of(m);
  fill_rows(m, true);
  items_.clear();
  for (std::uint32_t i = 0; i < m.joints.size(); ++i) {
    if (m.joints[i].rigid && m.joints[i].on) items_.push_back({Item::joint, i});
  }
  for (std::uint32_t i = 0; i < m.couplings.size(); ++i) {
    if (is_rigid(m.couplings[i])) items_.push_back({Item::coupling, i});
  }
  for (std::uint32_t i = 0; i < m.rows.size(); ++i) items_.push_back({Item::drive, i});
  sort_items(m);
  fill(m);
  std::vector<std::uint32_t> first(size());
  for (std::uint32_t r = 0; r < size(); ++r) first[r] = r;
  on_body_.assign(m.bodies.size(), {});
  for (std::uint32_t s = 0; s < sides_.size(); ++s) {
    if (gives_way_[sides_[s].body]) on_body_[sides_[s].body].push_back(s);
  }
  for (const auto& on : on_body_) {
    for (const std::uint32_t s : on) first[sides_[s].row] = std::min(first[sides_[s].row], sides_[on[0]].row);
  }
  matrix_.lay_out(std::move(first));
  item_of_row_.resize(size());
  for (std::uint32_t i = 0; i < items_.size(); ++i) {
    for (std::uint32_t r = items_[i].first_row; r < size(); ++r) item_of_row_[r] = i;
  }
}

DEM_INLINE void RigidRows::update(Parts& m) {
  if (!m.motions.empty()) fill_rows(m, true);
  fill(m);
  matrix_.set_zero();
  for (const auto& on : on_body_) {
    for (std::size_t k = 0; k < on.size(); ++k) {
      const Side& x = sides_[on[k]];
      for (std::size_t l = 0; l <= k; ++l) {
        const Side& y = sides_[on[l]];
        const double a = dot(y.push.force, x.velocity) + dot(y.torque, x.spin);
        matrix_.at(x.row, y.row) += l < k && x.row == y.row ? 2.0 * a : a;
      }
    }
  }
  // The root of it is the angle between a row and what those before it span: closed loops have rows too many.
  matrix_.factorise(1e-13);
}

DEM_INLINE void RigidRows::speed_errors(const Parts& m, std::vector<double>& x) const {
  x = rates_;
  for (const Side& s : sides_) {
    const integrator::Motion<double>& b = m.bodies[s.body].motion;
    x[s.row] -= dot(s.push.force, b.velocity) + dot(s.torque, b.angular_velocity);
  }
}

DEM_INLINE double RigidRows::errors(Parts& m, std::vector<double>& x, double per_metre) const {
  if (!m.motions.empty()) fill_rows(m, true);
  x.resize(size());
  double worst = 0.0;
  for (const Item& item : items_) {
    double* out = &x[item.first_row];
    const auto put = [&](double error, double scale) {
      *out++ = error;
      worst = std::max(worst, std::abs(error) * scale);
    };
    if (item.kind == Item::joint) {
      const Joint& j = m.joints[item.index];
      for_each_error(j, m.bodies[j.a], m.bodies[j.b], per_metre, put);
    } else if (item.kind == Item::coupling) {
      const Coupling& g = m.couplings[item.index];
      put(coupling_sum(g.spec, m.joints, m.bodies) - g.offset, 1.0);
    } else {
      const JacobianRow& r = m.rows[item.index];
      put(r.now.value - r.value, r.now.rotation ? 1.0 : per_metre);
    }
  }
  return worst;
}

DEM_INLINE std::uint64_t RigidRows::key_of(const Parts& m) {
  std::uint64_t key = 0xcbf29ce484222325u;  // of Fowler, Noll and Vo
  const auto add = [&](bool on) { key = (key ^ (on ? 2u : 1u)) * 0x100000001b3u; };
  for (const Joint& j : m.joints) add(j.on && j.rigid);
  for (const Coupling& g : m.couplings) add(is_rigid(g));
  for (const PrescribedMotion& p : m.motions) add(p.spec.on);
  return key;
}

DEM_INLINE void RigidRows::sort_items(const Parts& m) {
  const std::size_t n = items_.size();
  std::vector<std::vector<std::uint32_t>> on(m.bodies.size()), next(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    for_each_body(m, items_[i], [&](std::uint32_t b) {
      if (gives_way(m, b)) on[b].push_back(i);
    });
  }
  for (const auto& items : on) {
    for (const std::uint32_t i : items) next[i].insert(next[i].end(), items.begin(), items.end());
  }
  std::vector<std::uint32_t> order, by_degree(n);
  for (std::uint32_t i = 0; i < n; ++i) by_degree[i] = i;
  const auto fewer = [&](std::uint32_t a, std::uint32_t b) { return next[a].size() < next[b].size(); };
  std::stable_sort(by_degree.begin(), by_degree.end(), fewer);
  std::vector<bool> seen(n, false);
  for (const std::uint32_t start : by_degree) {
    if (seen[start]) continue;
    seen[start] = true;
    order.push_back(start);
    for (std::size_t at = order.size() - 1; at < order.size(); ++at) {
      std::vector<std::uint32_t> near;
      for (const std::uint32_t i : next[order[at]]) {
        if (!seen[i]) near.push_back(i);
        seen[i] = true;
      }
      std::stable_sort(near.begin(), near.end(), fewer);
      order.insert(order.end(), near.begin(), near.end());
    }
  }
  std::vector<Item> sorted;
  for (std::size_t k = n; k-- > 0;) sorted.push_back(items_[order[k]]);
  items_ = std::move(sorted);
}

DEM_INLINE void RigidRows::fill(const Parts& m) {
  rates_.clear();
  sides_.clear();
  const std::size_t n = m.bodies.size();
  gives_way_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) gives_way_[i] = gives_way(m, i);
  for (Item& item : items_) {
    item.first_row = static_cast<std::uint32_t>(rates_.size());
    if (item.kind == Item::joint) {
      add_joint(m, m.joints[item.index]);
    } else if (item.kind == Item::coupling) {
      for (const auto& term : m.couplings[item.index].spec.terms) {
        const Joint& j = m.joints[term.joint.index()];
        const Coordinate q = coordinate_of(j, m.bodies[j.a], m.bodies[j.b], term.dof);
        add_side(m, j.b, term.ratio * push_on_b(q));
        add_side(m, j.a, term.ratio * push_on_a(q));
      }
      rates_.push_back(0.0);
    } else {
      const JacobianRow& r = m.rows[item.index];
      add_side(m, r.b, push_on_b(r.now));
      if (r.a != JacobianRow::no_body) add_side(m, r.a, push_on_a(r.now));
      rates_.push_back(r.rate);
    }
  }
}

DEM_INLINE void RigidRows::add_side(const Parts& m, std::uint32_t body, const Wrench& push) {
  const Body& b = m.bodies[body];
  const V none = {0, 0, 0}, t = transpose_times(b.motion.rotation, push.torque);
  Side s{body, static_cast<std::uint32_t>(rates_.size()), push, t, none, none};
  if (gives_way_[body]) {
    s.velocity = (1.0 / b.mass) * push.force;
    s.spin = {t.x / b.inertia[0], t.y / b.inertia[1], t.z / b.inertia[2]};
  }
  sides_.push_back(s);
}

DEM_INLINE void RigidRows::add_joint(const Parts& m, const Joint& j) {
  const Body &a = m.bodies[j.a], &b = m.bodies[j.b];
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const V arm_b = B * j.point_b, arm_a = b.motion.position - a.motion.position + arm_b;
  const auto displacement = [&](const V& n) {
    add_side(m, j.b, {n, cross(arm_b, n)});
    add_side(m, j.a, {-n, -cross(arm_a, n)});
    rates_.push_back(0.0);
  };
  const auto rotation = [&](const V& n) {
    add_side(m, j.b, {{0, 0, 0}, n});
    add_side(m, j.a, {{0, 0, 0}, -n});
    rates_.push_back(0.0);
  };
  const JointTraits& traits = traits_of(j.kind);
  if (traits.hold == Hold::length) {
    const V d = arm_a - A * j.point_a;
    const V n = (1.0 / max(norm(d), 1e-300)) * d, foot = A * j.point_a;
    add_side(m, j.b, {n, cross(arm_b, n)});
    add_side(m, j.a, {-n, -cross(foot, n)});
    rates_.push_back(0.0);
  } else {
    for_each_held_axis(j, traits.hold, [&](const V& axis) { displacement(A * axis); });
  }
  for_each_rotation_row(j, traits.align, A, B, rotation);
}

}  // namespace dem::mbd::detail

#endif
