#pragma once

// An answer that owes nothing to the solver: the kinematics of a double wishbone from its points alone, and with it the
// energies of the whole vehicle over ten coordinates, whose minimum is the state at rest and whose curvature gives the
// frequencies. Rigid joints, no friction, tyres without side force.

#include <dem/vehicle/humvee.hpp>

#include <Eigen/Dense>

#include <cmath>
#include <vector>

namespace dem::vehicle::test {

/// One corner over the angle of its lower arm (rad, about the axis forward), chassis at rest.
struct Corner {
  WishbonePoints p;
  bool is_left = true;

  struct Pose {
    Vec3 lower, upper, rod;
    Mat3 lower_turn, upper_turn, turn;  // of the arms and of the knuckle
    Vec3 carried(const WishbonePoints& p, const Vec3& point) const { return lower + turn * (point - p.lower_ball); }
  };

  static Mat3 about(const Vec3& axis, double q) { return Eigen::AngleAxisd(q, axis.normalized()).toRotationMatrix(); }
  static Mat3 frame(const Vec3& a, const Vec3& b, const Vec3& c) {
    Mat3 f;
    f.col(0) = (b - a).normalized();
    f.col(2) = f.col(0).cross(c - a).normalized();
    f.col(1) = f.col(2).cross(f.col(0));
    return f;
  }

  Pose at(double q) const {
    Pose s;
    s.lower_turn = about(p.lower_front - p.lower_back, q);
    s.lower = p.lower_back + s.lower_turn * (p.lower_ball - p.lower_back);
    // The upper arm: its ball joint keeps its distance from the lower one.
    const double length = (p.upper_ball - p.lower_ball).norm();
    const auto upper = [&](double angle) -> Vec3 {
      return p.upper_back + about(p.upper_front - p.upper_back, angle) * (p.upper_ball - p.upper_back);
    };
    const auto error = [&](double angle) { return (upper(angle) - s.lower).norm() - length; };
    double x0 = q, x1 = q + 0.01, e0 = error(x0), e1 = error(x1);
    for (int k = 0; k < 50 && std::abs(e1 - e0) > 1e-16; ++k) {
      const double next = x1 - e1 * (x1 - x0) / (e1 - e0);
      x0 = x1, e0 = e1, x1 = next, e1 = error(x1);
    }
    s.upper_turn = about(p.upper_front - p.upper_back, x1);
    s.upper = upper(x1);
    // The rod's end: the place on three spheres, on the side where it is drawn.
    const double ra = (p.rod_outer - p.lower_ball).norm(), rb = (p.rod_outer - p.upper_ball).norm(),
                 rc = (p.rod_outer - p.rod_inner).norm();
    const Vec3 ex = (s.upper - s.lower).normalized();
    const double i = ex.dot(p.rod_inner - s.lower);
    const Vec3 ey = (p.rod_inner - s.lower - i * ex).normalized(), ez = ex.cross(ey);
    const double j = ey.dot(p.rod_inner - s.lower);
    const double x = (ra * ra - rb * rb + length * length) / (2.0 * length);
    const double y = (ra * ra - rc * rc + i * i + j * j - 2.0 * i * x) / (2.0 * j);
    const double z = std::sqrt(std::max(0.0, ra * ra - x * x - y * y));
    const Vec3 drawn = (p.upper_ball - p.lower_ball).cross(p.rod_inner - p.lower_ball);
    const double side = drawn.dot(p.rod_outer - p.lower_ball) > 0.0 ? 1.0 : -1.0;
    s.rod = s.lower + x * ex + y * ey + side * z * ez;
    s.turn = frame(s.lower, s.upper, s.rod) * frame(p.lower_ball, p.upper_ball, p.rod_outer).transpose();
    return s;
  }
  double travel(double q) const { return at(q).carried(p, p.wheel).z() - p.wheel.z(); }
  Vec3 axis(double q) const { return at(q).turn * Vec3::UnitY(); }
};

/// The vehicle over x, y, z, roll, pitch, yaw of the chassis' origin and the angles of the four lower arms.
struct RigidModel {
  using State = Eigen::Matrix<double, 10, 1>;
  using Matrix = Eigen::MatrixXd;

  VehicleSpec s;
  double gravity = 9.81;

  struct Mass {
    double mass;
    Vec3 inertia;
    Vec3 at;
    Mat3 turn;
  };

  static Mat3 rotation(const State& u) {
    return Corner::about(Vec3::UnitZ(), u[5]) * Corner::about(Vec3::UnitY(), u[4]) * Corner::about(Vec3::UnitX(), u[3]);
  }
  Corner corner(std::size_t k) const {
    const WishbonePoints& left = k < 2 ? s.front.points : s.rear.points;
    return {k % 2 == 0 ? left : left.mirrored(), k % 2 == 0};
  }

  /// All bodies; the last four are the wheels, whose spin is no coordinate of its own.
  std::vector<Mass> masses(const State& u) const {
    const Mat3 r = rotation(u);
    const Vec3 origin = u.head<3>();
    std::vector<Mass> list, wheels;
    const auto add = [&](const PartMass& m, const Vec3& at, const Mat3& turn = Mat3::Identity()) {
      list.push_back({m.mass, m.inertia, origin + r * at, r * turn});
    };
    add(s.chassis, s.chassis_centre);
    const RackSteeringSpec& steering = s.steering;
    const Vec3 rack(steering.rod_inner.x(), 0, steering.rod_inner.z());
    add(steering.rack, rack);
    add(steering.pinion, rack + Vec3(0, 0, steering.pinion_radius));
    add(s.driveline.shaft, s.driveline.shaft_middle);
    for (std::size_t k = 0; k < 4; ++k) {
      const DoubleWishboneSpec& w = k < 2 ? s.front : s.rear;
      const AxleSpec& axle = k < 2 ? s.driveline.front : s.driveline.rear;
      const Corner c = corner(k);
      const Corner::Pose pose = c.at(u[6 + static_cast<int>(k)]);
      const double side = c.is_left ? 1.0 : -1.0;
      if (c.is_left) {
        add(axle.cage, axle.middle);
        add(axle.pinion, axle.middle + axle.pinion_ahead * Vec3::UnitX());
      }
      add(w.lower_arm, c.p.lower_back + pose.lower_turn * (c.p.lower_centre() - c.p.lower_back), pose.lower_turn);
      add(w.upper_arm, c.p.upper_back + pose.upper_turn * (c.p.upper_centre() - c.p.upper_back), pose.upper_turn);
      add(w.knuckle, pose.carried(c.p, c.p.knuckle), pose.turn);
      if (k < 2) add({s.steering.rod.mass, Vec3::Zero()}, 0.5 * (c.p.rod_inner + pose.rod));
      // The half shaft keeps its length; its inner joint plunges along y.
      const Vec3 drawn(axle.outer.x(), side * axle.outer.y(), axle.outer.z());
      const Vec3 inner = axle.middle + side * axle.side_shaft_end * Vec3::UnitY(), outer = pose.carried(c.p, drawn);
      const double length = (drawn - inner).norm(), dx = outer.x() - inner.x(), dz = outer.z() - inner.z();
      const double y = outer.y() - side * std::sqrt(length * length - dx * dx - dz * dz);
      add({axle.half_shaft.mass, Vec3::Zero()}, 0.5 * (outer + Vec3(inner.x(), y, inner.z())));
      add({axle.side_shaft.mass, Vec3::Zero()}, axle.middle + Vec3(0, y - 0.5 * side * axle.side_shaft_end, 0));
      const Vec3 moments = s.wheel.mass.inertia;
      wheels.push_back({s.wheel.mass.mass, Vec3(moments.x(), 0, moments.z()), origin + r * pose.carried(c.p, c.p.wheel),
                        r * pose.turn});
    }
    list.insert(list.end(), wheels.begin(), wheels.end());
    return list;
  }

  double deflection(const State&, const Mass& wheel) const {
    const double lean = (wheel.turn * Vec3::UnitY()).z();
    return std::sqrt(1.0 - lean * lean) * s.tyre.radius - wheel.at.z();
  }
  double spring_energy(const DoubleWishboneSpec& w, double length) const {
    // The force is straight between the points of its table: the trapezoids are exact.
    const double compression = w.spring_free_length - length;
    double energy = 0.0, x = 0.0;
    for (const auto& [to, force] : w.spring_force.points()) {
      if (to <= x) continue;
      if (to >= compression) break;
      energy += 0.5 * (to - x) * (w.spring_force(x) + force);
      x = to;
    }
    return energy + 0.5 * (compression - x) * (w.spring_force(x) + w.spring_force(compression));
  }
  double energy(const State& u) const {
    double v = 0.0;
    const std::vector<Mass> all = masses(u);
    for (const Mass& m : all) v += m.mass * gravity * m.at.z();
    for (std::size_t k = 0; k < 4; ++k) {
      const DoubleWishboneSpec& w = k < 2 ? s.front : s.rear;
      const Corner c = corner(k);
      const Corner::Pose pose = c.at(u[6 + static_cast<int>(k)]);
      const Vec3 on_arm = c.p.lower_back + pose.lower_turn * (c.p.spring_arm - c.p.lower_back);
      v += spring_energy(w, (on_arm - c.p.spring_chassis).norm());
      const double d = std::max(0.0, deflection(u, all[all.size() - 4 + k]));
      v += 0.5 * s.tyre.stiffness * d * d;
    }
    return v;
  }

  /// Curvature of the energy, by differences, over coordinates w with u = u0 + modes w.
  Matrix stiffness(const State& u, const Matrix& modes, double h = 2e-4) const {
    const long n = modes.cols();
    Matrix k(n, n);
    const auto at = [&](long i, double a, long j, double b) { return energy(u + a * modes.col(i) + b * modes.col(j)); };
    for (long i = 0; i < n; ++i) {
      for (long j = 0; j < n; ++j) {
        k(i, j) = (at(i, h, j, h) - at(i, h, j, -h) - at(i, -h, j, h) + at(i, -h, j, -h)) / (4.0 * h * h);
      }
    }
    return k;
  }
  /// The mass matrix over the same coordinates. Wheels roll: they spin with their way forward.
  Matrix mass(const State& u, const Matrix& modes, double h = 1e-5) const {
    const long n = modes.cols();
    const std::vector<Mass> here = masses(u);
    const double radius = s.tyre.radius - deflection(u, here.back());
    std::vector<std::vector<Vec3>> way, turn;
    for (long i = 0; i < n; ++i) {
      const std::vector<Mass> up = masses(u + h * modes.col(i)), down = masses(u - h * modes.col(i));
      way.emplace_back(), turn.emplace_back();
      for (std::size_t b = 0; b < here.size(); ++b) {
        way.back().push_back((up[b].at - down[b].at) / (2.0 * h));
        const Mat3 w = (up[b].turn - down[b].turn) / (2.0 * h) * here[b].turn.transpose();
        turn.back().push_back(here[b].turn.transpose() *
                              Vec3(0.5 * (w(2, 1) - w(1, 2)), 0.5 * (w(0, 2) - w(2, 0)), 0.5 * (w(1, 0) - w(0, 1))));
      }
    }
    Matrix m = Matrix::Zero(n, n);
    for (long i = 0; i < n; ++i) {
      for (long j = 0; j < n; ++j) {
        for (std::size_t b = 0; b < here.size(); ++b) {
          const auto a = static_cast<std::size_t>(i), c = static_cast<std::size_t>(j);
          m(i, j) += here[b].mass * way[a][b].dot(way[c][b]) + turn[a][b].dot(here[b].inertia.cwiseProduct(turn[c][b]));
          if (b + 4 >= here.size()) {
            m(i, j) += s.wheel.mass.inertia.y() / (radius * radius) * way[a][b].x() * way[c][b].x();
          }
        }
      }
    }
    return m;
  }

  /// x, z, pitch, front arms, rear arms: both sides move alike.
  static Matrix symmetric() {
    Matrix m = Matrix::Zero(10, 5);
    m(0, 0) = m(2, 1) = m(4, 2) = m(6, 3) = m(8, 4) = 1.0;
    m(7, 3) = m(9, 4) = -1.0;
    return m;
  }
  /// y, roll, yaw, front arms, rear arms: both sides move against each other.
  static Matrix antisymmetric() {
    Matrix m = Matrix::Zero(10, 5);
    m(1, 0) = m(3, 1) = m(5, 2) = m(6, 3) = m(7, 3) = m(8, 4) = m(9, 4) = 1.0;
    return m;
  }

  /// The state at rest, by Newton's method.
  State at_rest() const {
    State u = State::Zero();
    u[2] = s.tyre.radius + 0.05;
    u[6] = u[8] = -0.1;
    u[7] = u[9] = 0.1;
    const Matrix modes = symmetric().rightCols(4);
    for (int step = 0; step < 30; ++step) {
      Eigen::VectorXd g(4);
      const double h = 1e-5;
      for (int i = 0; i < 4; ++i) g[i] = (energy(u + h * modes.col(i)) - energy(u - h * modes.col(i))) / (2.0 * h);
      const Eigen::VectorXd by = stiffness(u, modes).ldlt().solve(g);
      u -= modes * by * std::min(1.0, 0.02 / by.cwiseAbs().maxCoeff());
      if (by.cwiseAbs().maxCoeff() < 1e-9) break;
    }
    return u;
  }
};

}  // namespace dem::vehicle::test
