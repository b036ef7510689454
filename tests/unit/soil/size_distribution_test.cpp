#include "core/error_of.hpp"
#include "worlds.hpp"

#include <dem/soil/size_classes.hpp>

#include <cmath>
#include <numbers>

using Catch::Approx;
using dem::soil::Counted;
using dem::soil::size_classes;
using dem::soil::SizeDistribution;

namespace {

/// The mean of d^power of the grains of all classes, by number.
double mean_of(const std::vector<dem::soil::SizeClass>& classes, double power) {
  double sum = 0.0;
  for (const auto& c : classes) sum += c.number * std::pow(c.size, power);
  return sum;
}
constexpr double six = 6.0;  // deviations: what lies beyond is 2e-9 of a normal distribution

}  // namespace

// Moments are integrated numerically, with an error of the order of 1e-10; the margins below are larger only where what
// is compared with is not exact.

TEST_CASE("sizes that are spread evenly") {
  const double a = 1e-3, b = 3e-3;
  const auto d = SizeDistribution::uniform(a, b);
  CHECK(d.size_at(0.25) == Approx(1.5e-3).epsilon(1e-12));
  CHECK(d.share_below(2.5e-3) == Approx(0.75));
  CHECK(d.share_below(0.5e-3) == 0.0);
  CHECK(d.share_below(1.0) == 1.0);
  CHECK(d.moment(1, a, b) == Approx(0.5 * (a + b)).epsilon(1e-9));
  CHECK(d.moment(3, a, b) == Approx((std::pow(b, 4) - std::pow(a, 4)) / (4 * (b - a))).epsilon(1e-9));
  CHECK(d.moment(-3, a, b) == Approx((1 / (a * a) - 1 / (b * b)) / (2 * (b - a))).epsilon(1e-9));
  CHECK(d.moment(0, 1.5e-3, 2e-3) == Approx(0.25));
}

TEST_CASE("sizes with a normal distribution, cut at three deviations") {
  const double mean = 2e-3, s = 0.3e-3;
  const auto d = SizeDistribution::normal(mean, s);
  CHECK(d.low() == Approx(1.1e-3));
  CHECK(d.high() == Approx(2.9e-3));
  CHECK(d.size_at(0.5) == Approx(mean).epsilon(1e-12));
  // Of the uncut one 84.134 % lie below one deviation; of the cut one (0.84134 - 0.00135)/0.99730.
  CHECK(d.share_below(mean + s) == Approx((0.841344746 - 0.001349898) / 0.997300204).epsilon(1e-8));
  const double first = d.moment(1, 0, 1), second = d.moment(2, 0, 1);
  CHECK(first == Approx(mean).epsilon(1e-9));
  const double density = std::exp(-4.5) / std::sqrt(2 * std::numbers::pi);
  CHECK(second - first * first == Approx(s * s * (1 - 6 * density / 0.997300204)).epsilon(1e-6));
}

TEST_CASE("sizes with a lognormal distribution, by number and by mass, are one by Hatch and Choate") {
  // Of grains whose number is lognormal with the median m and the deviation s of the logarithm, the mass is so too,
  // with the median m exp(3 s^2); the mean of d^k is m^k exp(k^2 s^2/2).
  const double m = 1e-3, ratio = 1.3, s = std::log(ratio), wide = std::pow(ratio, 9.0);
  const auto number = SizeDistribution::lognormal(m, ratio, Counted::by_number, {m / wide, m * wide});
  for (const double k : {1.0, 2.0, 3.0, -3.0}) {
    CHECK(number.moment(k, 0, 1) == Approx(std::pow(m, k) * std::exp(0.5 * k * k * s * s)).epsilon(1e-8));
  }
  CHECK(number.size_at(0.5) == Approx(m).epsilon(1e-9));
  CHECK(number.share_below(m * ratio) == Approx(0.841344746).epsilon(1e-8));
  const double median = m * std::exp(3 * s * s);
  const auto mass = SizeDistribution::lognormal(median, ratio, Counted::by_mass, {m / wide, m * wide});
  // One class stands for all grains: the cube root of the mean cube of the numbers.
  const double size = size_classes(number, 1)[0].size;
  CHECK(size == Approx(m * std::exp(1.5 * s * s)).epsilon(1e-8));
  // By mass the cut at the lower end, at 9 - 3 s = 8.2 deviations, takes no number either.
  CHECK(size_classes(mass, 1)[0].size == Approx(size).epsilon(1e-7));
  // Half of the mass is in grains above the median by mass.
  CHECK(number.moment(3, median, 1) / number.moment(3, 0, 1) == Approx(0.5).epsilon(1e-8));
}

TEST_CASE("sizes with a Weibull distribution") {
  const double scale = 2e-3, shape = 2.5;
  const auto d = SizeDistribution::weibull(scale, shape, Counted::by_number, {1e-7, 8e-3});  // cuts 1e-14 off
  CHECK(d.size_at(0.3) == Approx(scale * std::pow(-std::log(0.7), 1 / shape)).epsilon(1e-9));
  CHECK(d.share_below(scale) == Approx(1 - std::exp(-1.0)).epsilon(1e-9));
  for (const double k : {1.0, 2.0, 3.0}) {
    CHECK(d.moment(k, 0, 1) == Approx(std::pow(scale, k) * std::tgamma(1 + k / shape)).epsilon(1e-7));
  }
  // Unless told otherwise a thousandth is cut off at each end.
  const auto cut = SizeDistribution::weibull(scale, shape);
  CHECK(cut.low() == Approx(scale * std::pow(-std::log(0.999), 1 / shape)));
  CHECK(cut.high() == Approx(scale * std::pow(-std::log(0.001), 1 / shape)));
}

TEST_CASE("sizes from a sieve curve") {
  const auto d = SizeDistribution::sieve_curve({{0.5e-3, 0}, {1e-3, 20}, {2e-3, 70}, {4e-3, 100}});
  CHECK(d.counted() == Counted::by_mass);
  CHECK(d.share_below(1e-3) == Approx(0.2));
  CHECK(d.share_below(2e-3) == Approx(0.7));
  CHECK(d.share_below(std::sqrt(2.0) * 1e-3) == Approx(0.45));  // straight over the logarithm
  CHECK(d.size_at(0.85) == Approx(std::sqrt(8.0) * 1e-3));
  CHECK(d.size_at(0.0) == Approx(0.5e-3));
  CHECK(d.size_at(1.0) == Approx(4e-3));
  // Between two sieves the density is c/d, with c = share/ln(2): the mean of d^-3 is c/3 (a^-3 - b^-3).
  const auto one = [](double share, double a) {
    const double b = 2 * a;
    return share / std::log(2.0) / 3 * (1 / (a * a * a) - 1 / (b * b * b));
  };
  // Its corners are what the integration is worst at.
  CHECK(d.moment(-3, 0, 1) == Approx(one(0.2, 0.5e-3) + one(0.5, 1e-3) + one(0.3, 2e-3)).epsilon(1e-4));
}

TEST_CASE("classes have the number and the mass of what they stand for") {
  const double m = 1e-3, ratio = 1.5, s = std::log(ratio), wide = std::pow(ratio, six);
  for (const Counted by : {Counted::by_number, Counted::by_mass}) {
    const double median = by == Counted::by_number ? m : m * std::exp(3 * s * s);
    const auto d = SizeDistribution::lognormal(median, ratio, by, {median / wide, median * wide});
    for (const std::size_t n : {1U, 3U, 8U, 20U}) {
      const auto classes = size_classes(d, n);
      REQUIRE(classes.size() == n);
      double numbers = 0.0, masses = 0.0;
      for (const auto& c : classes) {
        numbers += c.number, masses += c.mass;
        CHECK((by == Counted::by_number ? c.number : c.mass) == Approx(1.0 / static_cast<double>(n)));
        CHECK(c.size > c.from);
        CHECK(c.size < c.to);
      }
      CHECK(numbers == Approx(1.0));
      CHECK(masses == Approx(1.0));
      // The mass of a million grains is right for any n. The cut ends hold 2e-9 of what is counted, and of the other
      // what lies 6 - 3 s = 4.8 deviations from its own median: 1e-6.
      CHECK(mean_of(classes, 3) == Approx(m * m * m * std::exp(4.5 * s * s)).epsilon(4e-6));
      if (n == 8) CHECK(mean_of(classes, 1) == Approx(m * std::exp(0.5 * s * s)).epsilon(0.05));
      if (n == 20) CHECK(mean_of(classes, 1) == Approx(m * std::exp(0.5 * s * s)).epsilon(0.02));
    }
  }
}

TEST_CASE("a world gets a species for each class, as a mixture that is drawn by mass") {
  dem::World<models::Balls> w;
  const auto d = SizeDistribution::uniform(1e-3, 2e-3, Counted::by_mass);
  const dem::Mixture sand =
      dem::soil::add_sizes(w, d, 5, [](double size) { return dem::shape::Sphere(0.5 * size); }, {.density = 1000});
  REQUIRE(sand.parts.size() == 5);
  CHECK(sand.by == dem::ShareOf::mass);
  const dem::MixtureDraw draw(sand, [&](dem::SpeciesId s) { return w.species(s).mass; });
  dem::RandomStream random(3);
  std::vector<double> mass(5);
  double all = 0.0;
  for (int k = 0; k < 100000; ++k) {
    const dem::SpeciesId s = draw.draw(random);
    mass[s.index()] += w.species(s).mass;
    all += w.species(s).mass;
  }
  // The largest class has about a tenth of the grains: 1 % is three deviations of its count.
  for (const double m : mass) CHECK(m / all == Approx(0.2).epsilon(0.03));
  CHECK(w.species(sand.parts[0].species).density == 1000);
}

TEST_CASE("mixtures of mixtures") {
  const dem::Mixture a = {{{dem::SpeciesId(0), 3.0}, {dem::SpeciesId(1), 1.0}}}, b = dem::SpeciesId(2);
  const dem::Mixture both = a.with(0.2, b);
  REQUIRE(both.parts.size() == 3);
  CHECK(both.parts[0].share == Approx(0.6));
  CHECK(both.parts[1].share == Approx(0.2));
  CHECK(both.parts[2].share == Approx(0.2));
  const dem::Mixture counted({{dem::SpeciesId(0), 1.0}}, dem::ShareOf::number);
  check_refused([&] { a.with(0.2, counted); }, "one mixture counts by mass and one by number");
  check_refused([&] { a.with(1.2, b); }, "share of a mixture in another is 1.2");
  check_refused([&] { a.with(0.2, dem::Mixture()); }, "a mixture has no grains in it");
}

TEST_CASE("random numbers have the moments of what they are drawn from") {
  dem::RandomStream random(7);
  const int n = 100000;
  double first = 0.0, second = 0.0, trace = 0.0, z = 0.0;
  for (int k = 0; k < n; ++k) {
    const double u = random.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    first += u / n, second += u * u / n;
    const dem::Mat3 r = random.rotation();
    trace += r.trace() / n, z += r(2, 2) * r(2, 2) / n;
  }
  // Deviations of the means: sqrt(1/12), sqrt(4/45), 1 and sqrt(4/45), over sqrt(n); four of each.
  CHECK(first == Approx(0.5).margin(4 * std::sqrt(1.0 / 12 / n)));
  CHECK(second == Approx(1.0 / 3).margin(4 * std::sqrt(4.0 / 45 / n)));
  CHECK(trace == Approx(0.0).margin(4.0 / std::sqrt(n)));
  CHECK(z == Approx(1.0 / 3).margin(4 * std::sqrt(4.0 / 45 / n)));
  // The first numbers of SplitMix64 with the seed 1234567, as published with it.
  dem::RandomStream known(1234567);
  CHECK(known.bits() == 6457827717110365317ULL);
  CHECK(known.bits() == 3203168211198807973ULL);
}

TEST_CASE("distributions that make no sense are refused") {
  check_refused([] { SizeDistribution::uniform(2e-3, 1e-3); }, "sizes go from 0.002 to 0.001 m");
  check_refused([] { SizeDistribution::normal(1e-3, 0.5e-3); }, "give other limits or a smaller deviation");
  check_refused([] { SizeDistribution::normal(1e-3, 0); }, "standard deviation of a size is 0 m");
  check_refused([] { SizeDistribution::lognormal(1e-3, 1.0); }, "geometric standard deviation of a size is 1");
  check_refused([] { SizeDistribution::weibull(1e-3, 0.0); }, "shape of a Weibull distribution is 0");
  check_refused([] { SizeDistribution::sieve_curve({{1e-3, 0}}); }, "has 1 points");
  check_refused([] { SizeDistribution::sieve_curve({{1e-3, 0}, {2e-3, 90}}); }, "must go from 0 to 1 or to 100");
  check_refused([] { SizeDistribution::sieve_curve({{1e-3, 0}, {3e-3, 0.6}, {2e-3, 1}}); }, "must ascend");
  check_refused([] { size_classes(SizeDistribution::uniform(1e-3, 2e-3), 0); }, "cut into 0 classes");
}
