#include <dem/geometry/contact_shares.hpp>

#include <vector>

#include "catch.hpp"

namespace weights_test {

using dem::Vector3;
using dem::contact::ContactPoint;
using dem::contact::Fit;

namespace {

struct Point {
  double overlap, weight;
  Vector3<double> normal = {1, 0, 0};
};

/// Contact points with these weights, fitted.
std::vector<ContactPoint<double>> fitted(const std::vector<Point>& points, Fit fit) {
  std::vector<ContactPoint<double>> contact_points;
  for (const Point& p : points) contact_points.push_back({p.normal, p.overlap, {0, 0, 0}, 1.0, p.weight});
  dem::contact::fit_weights(contact_points.size(), fit,
                            [&](std::size_t k) -> ContactPoint<double>& { return contact_points[k]; });
  return contact_points;
}
double weight(const std::vector<Point>& points, Fit fit) {
  double sum = 0.0;
  for (const auto& t : fitted(points, fit)) sum += t.weight;
  return sum;
}
/// Sum of weight times overlap: the force of a contact with K = 1.
double force(const std::vector<Point>& points, Fit fit = Fit::always) {
  double sum = 0.0;
  for (const auto& t : fitted(points, fit)) sum += t.weight * std::max(0.0, t.overlap);
  return sum;
}

}  // namespace

TEST_CASE("points that share a contact are one whole contact, and none jumps in or out") {
  CHECK(force({}) == 0.0);
  // Across a gap the nearest is the whole of it; a point that faces another way is a contact of its own.
  const auto apart = fitted({{-2e-4, 0.5}, {-1e-4, 0.3}, {-3e-4, 0.7, {-1, 0, 0}}}, Fit::always);
  CHECK(apart[0].weight == 0.0);
  CHECK(apart[1].weight == 1.0);
  CHECK(apart[2].weight == 1.0);
  CHECK(force({{0.1, 0.3}}) == Approx(0.1));
  CHECK(force({{0.1, 2.0}, {0.1, 3.0}, {0.1, 1.0}}) == Approx(0.1));
  CHECK(force({{0.1, 1.0}, {0.1, 1.0}, {1e-9, 1.0}}) == Approx(0.1).epsilon(1e-7));
  CHECK(force({{0.1, 1.0}, {-0.1, 1.0}}) == Approx(0.1));  // a point across a gap counts nothing
  CHECK(force({{0.0, 1.0}, {0.0, 1.0}}) == 0.0);
  // Of unequal ones: sum w d^2 / sum w d. The weights' sum stays 1, so friction and dampers are those of one contact.
  CHECK(force({{0.1, 1.0}, {0.3, 1.0}}) == Approx((0.01 + 0.09) / 0.4));
  std::vector<Point> shallow(25, Point{0.01, 1.0});
  shallow.push_back({1.0, 1.0});
  CHECK(weight(shallow, Fit::always) == Approx(1.0));
  CHECK(fitted({{0.1, 1.0}, {1e-12, 1.0}}, Fit::always)[1].weight < 1e-10);
}

TEST_CASE("shares of less than a contact stay what they are, and go over into one without a jump") {
  const auto four = [](double w) { return std::vector<Point>(4, Point{0.1, w}); };
  CHECK(force({{0.1, 0.25}, {0.1, 0.25}}, Fit::if_more) == Approx(0.05));
  CHECK(force(four(0.25), Fit::if_more) == Approx(0.1));
  CHECK(force(four(0.5), Fit::if_more) == Approx(0.1));
  double last = 0.0;
  for (double w = 0.01; w < 1.0; w += 0.01) {
    const double f = force({{0.1, w}, {0.04, w}, {0.02, 0.5 * w}}, Fit::if_more);
    CHECK(std::abs(f - last) < 2.5e-3);  // 0.14 a unit of weight at the most
    CHECK(weight({{0.1, w}, {0.04, w}, {0.02, 0.5 * w}}, Fit::if_more) < 1.5);
    last = f;
  }
}

TEST_CASE("points on different sides are different contacts") {
  const Vector3<double> x = {1, 0, 0}, y = {0, 1, 0};
  const auto corner = fitted({{0.1, 1.0, x}, {0.1, 1.0, x}, {0.2, 1.0, y}, {0.2, 1.0, -x}}, Fit::always);
  CHECK(corner[0].weight == Approx(0.5));
  CHECK(corner[1].weight == Approx(0.5));
  CHECK(corner[2].weight == Approx(1.0));
  CHECK(corner[3].weight == Approx(1.0));
}

TEST_CASE("many points are weighted as if each looked at all the others") {
  // Sums of many points are over normals. Forty on three normals, one of which is rounded anew each time, against the
  // rule as it reads: each other point counts with the square of the cosine. Sums of 40 round to some 1e-14.
  const Vector3<double> x = {1, 0, 0}, y = {0, 1, 0}, oblique = {0.6, 0.0, 0.8};
  int between = 0;
  for (const double weight : {0.02, 0.15, 2.0}) {  // below one contact, between the rules, and above
    std::vector<Point> points;
    for (int k = 0; k < 40; ++k) {
      const double rounding = 1.0 + 1e-16 * (k % 7);
      const Vector3<double> normal = k % 3 == 0 ? x : k % 3 == 1 ? y : rounding * oblique;
      points.push_back({0.01 * (k % 11) - 0.02, weight * (1.0 + 0.1 * (k % 5)), normal});
    }
    for (const Fit fit : {Fit::always, Fit::if_more}) {
      const auto contact_points = fitted(points, fit);
      for (std::size_t k = 0; k < points.size(); ++k) {
        double first = 0.0, second = 0.0;
        for (const Point& p : points) {
          const double cosine = std::max(0.0, dot(points[k].normal, p.normal)), d = std::max(0.0, p.overlap);
          first += cosine * cosine * p.weight * d;
          second += cosine * cosine * p.weight * d * d;
        }
        const double n = first * first / second, over = std::clamp(n - 1.0, 0.0, 1.0);
        between += n > 1.0 && n < 2.0;
        const double whole = points[k].weight * std::max(0.0, points[k].overlap) / first;
        const double kept = n > 1.0 ? (1.0 - over) * points[k].weight / n : points[k].weight;
        CHECK(contact_points[k].weight ==
              Approx(fit == Fit::always ? whole : kept + over * whole).epsilon(1e-12).margin(1e-14));
      }
    }
  }
  CHECK(between > 10);
}

}  // namespace weights_test
