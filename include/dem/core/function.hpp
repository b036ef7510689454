#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace dem {

/// A callable of any type, as std::function is, without the rest of <functional>, which costs each user of a header a
/// quarter of a second of compiling. Copies are deep.
template <class Signature>
class Function;

template <class Result, class... Args>
class Function<Result(Args...)> {
 public:
  Function() = default;
  template <class F>
  requires(!std::is_same_v<F, Function> && std::is_invocable_r_v<Result, F&, Args...>)
      Function(F f) {  // NOLINT: any callable is one
    if constexpr (std::is_pointer_v<F> || requires { f.operator bool(); }) {
      if (!f) return;
    }
    call_.reset(new Held<F>(std::move(f)));  // make_unique would instantiate a second pointer type for each F
  }
  Function(const Function& other) : call_(other.call_ ? other.call_->copy() : nullptr) {}
  Function(Function&&) noexcept = default;
  Function& operator=(const Function& other) { return *this = Function(other); }
  Function& operator=(Function&&) noexcept = default;
  ~Function() = default;

  explicit operator bool() const { return call_ != nullptr; }
  /// There has to be a callable.
  Result operator()(Args... args) const { return call_->call(std::forward<Args>(args)...); }

 private:
  struct Call {
    virtual ~Call() = default;
    virtual Result call(Args... args) = 0;
    virtual Call* copy() const = 0;
  };
  template <class F>
  struct Held final : Call {
    explicit Held(F f) : function(std::move(f)) {}
    Result call(Args... args) override { return function(std::forward<Args>(args)...); }
    Call* copy() const override { return new Held(function); }
    F function;
  };

  std::unique_ptr<Call> call_;
};

}  // namespace dem
