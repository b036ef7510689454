#include "minimise.hpp"

#include <nlopt.hpp>

#include <algorithm>

std::vector<double> minimise(double (*function)(const double* x, const void* data), const void* data,
                             const std::vector<double>& start) {
  struct Call {
    double (*function)(const double*, const void*);
    const void* data;
  } call{function, data};
  const auto evaluate = [](unsigned, const double* x, double*, void* it) {
    const Call& c = *static_cast<const Call*>(it);
    return c.function(x, c.data);
  };
  std::vector<double> x = start;
  for (const auto algorithm : {nlopt::GN_DIRECT_L, nlopt::LN_BOBYQA}) {
    nlopt::opt search(algorithm, static_cast<unsigned>(x.size()));
    search.set_min_objective(evaluate, &call);
    search.set_lower_bounds(0.0);
    search.set_upper_bounds(1.0);
    search.set_maxeval(2000);
    search.set_xtol_abs(1e-7);
    double least = 0.0;
    try {
      search.optimize(x, least);
    } catch (const nlopt::roundoff_limited&) {  // as near as numbers go: x is what was found
    }
    for (double& v : x) v = std::clamp(v, 0.0, 1.0);  // DIRECT-L may end one rounding outside, where BOBYQA refuses x
  }
  return x;
}
