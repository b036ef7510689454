#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("a curve runs straight between its points and goes on outside") {
  const Curve c = {{0, 1}, {1, 3}, {3, 2}};
  CHECK(c(0.5) == Approx(2.0));
  CHECK(c(2.0) == Approx(2.5));
  CHECK(c(-1.0) == Approx(-1.0));
  CHECK(c(5.0) == Approx(1.0));
  CHECK(c.held_outside()(5.0) == Approx(2.0));
  CHECK(c.held_outside().slope(5.0) == 0.0);
  CHECK(c.held_outside().is_held_outside());
  CHECK_FALSE(c.is_held_outside());
  CHECK(c.slope(2.0) == Approx(-0.5));
  CHECK(c.steepest() == Approx(2.0));
  CHECK_THAT(message_of([] { Curve({{0, 1}}); }), Contains("has 1 points, but needs at least 2"));
  CHECK_THAT(message_of([] { Curve({{0, 1}, {0, 2}}); }), Contains("x must rise"));
}

TEST_CASE("signals know their rate") {
  const Signal signals[] = {Signal(2.0),
                            Signal::ramp(1.0, 0.5, 0.2),
                            Signal::sine(2.0, 3.0, 0.4, 1.0),
                            Signal::smooth_step(1.0, 4.0, 0.1, 0.9),
                            Signal::table({{0, 0}, {1, 2}, {2, 1}}),
                            Signal::function([](double t) { return t * t * t; })};
  for (const Signal& s : signals) {
    for (const double t : {0.05, 0.33, 0.71, 1.3}) {
      const double h = 1e-5;
      CHECK(s(t).rate == Approx((s(t + h).value - s(t - h).value) / (2 * h)).margin(1e-6));
    }
  }
  CHECK(Signal::held(1.0, 3.0)(7.0).rate == 3.0);
  CHECK(Signal::ramp(0.0, 2.0, 0.0, 1.0)(5.0).value == 2.0);
  CHECK_THAT(message_of([] { Signal::ramp(0, 0.5, 1, 0.5); }),
             Contains("ramp ends at 0.5 s") && Contains("start, 1 s"));
  CHECK(Signal::ramp(0.3, 0.5, 1, 1)(2.0).value == 0.3);
  CHECK_THAT(message_of([] { Signal::smooth_step(0, 1, 2, 2); }), Contains("must end after its start"));
}

TEST_CASE("the integral of a curve is exact within it and beyond, and its zero is found where it is") {
  const Curve c = {{0.0, 2.0}, {1.0, 0.0}, {3.0, -4.0}};
  CHECK(c.integral(0.0, 3.0) == Approx(1.0 - 4.0));
  CHECK(c.integral(3.0, 0.0) == Approx(3.0));
  CHECK(c.integral(0.5, 0.75) == Approx(0.25 * 0.75));
  CHECK(c.integral(-1.0, 4.0) == Approx(3.0 + 1.0 - 4.0 - 5.0));  // the slopes of the ends go on
  CHECK(c.held_outside().integral(-1.0, 4.0) == Approx(2.0 + 1.0 - 4.0 - 4.0));
  CHECK(c.integral(5.0, 7.0) == Approx(-2.0 * (8.0 + 12.0) / 2));
  CHECK(c.zero_or(9.0) == 1.0);
  CHECK(Curve({{0.0, 3.0}, {1.0, -1.0}}).zero_or(9.0) == Approx(0.75));
  CHECK(Curve::line(6.0, -2.0).zero_or(9.0) == Approx(3.0));  // beyond its end
  CHECK(Curve::line(6.0, 2.0).zero_or(9.0) == Approx(-3.0));  // before its start
  CHECK(Curve::line(6.0, 0.0).zero_or(9.0) == 9.0);           // nowhere
  CHECK(Curve::line(6.0, -2.0).held_outside().zero_or(9.0) == 9.0);
}
