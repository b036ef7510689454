// expect: exec::Cuda: compile this source with nvcc
#include <dem/parallel/cuda.hpp>
#include <dem/world/model.hpp>

struct Sand : dem::Model {
  using Executor = dem::exec::Cuda;
};

int main() { dem::check_model<Sand>(); }
