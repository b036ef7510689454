#pragma once

namespace dem {

/// A function of some type for the checks of concepts: `FunctionLike<void(int)>{}`. It stands there in place of a
/// lambda, which nvcc takes for a mistake within a requires-expression.
template <class Signature>
struct FunctionLike;
template <class Result, class... Arguments>
struct FunctionLike<Result(Arguments...)> {
  Result operator()(Arguments...) const { return Result(); }
};

}  // namespace dem
