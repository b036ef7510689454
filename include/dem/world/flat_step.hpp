#pragma once

#include <dem/parallel/executor.hpp>

namespace dem::flat {

/// The step of worlds whose executor has memory of its own, which <dem/flat/cuda.hpp> and <dem/flat/flat.hpp> define:
/// other programs are without that code.
template <class Model>
struct Step;

}  // namespace dem::flat

namespace dem {

/// Whether a model's grains live in its executor's memory while a world runs.
template <class Model>
constexpr bool is_flat() {
  if constexpr (exec::FlatExecutor<typename Model::Executor>) {
    static_assert(
        requires { sizeof(flat::Step<Model>); },
        "Executor: a program whose model has exec::Cuda includes <dem/flat/cuda.hpp>, one that has exec::Flat "
        "<dem/flat/flat.hpp>");
    return true;
  } else {
    return false;
  }
}

}  // namespace dem
