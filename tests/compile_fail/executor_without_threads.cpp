// expect: Executor: needs for_each\(n, f\) for f\(piece\) and f\(piece, thread\), threads\(\) and set_threads\(n\)
#include <dem/world/model.hpp>

struct Loop {
  template <class F>
  void for_each(std::size_t n, F&& f) const {
    for (std::size_t k = 0; k < n; ++k) f(k);
  }
};
struct Grain : dem::Model {
  using Executor = Loop;
};

int main() { dem::check_model<Grain>(); }
