#pragma once

/// For programs whose model has `using Executor = dem::exec::Cuda`, and that nvcc compiles.

#include <dem/flat/step.hpp>
#include <dem/parallel/cuda.hpp>
#include <dem/world/world.hpp>
