#pragma once
#include <memory>
#include <type_traits>
#include <utility>

namespace tumble {

template <class Signature>
class FunctionRef;

/// A non-owning reference to a callable object, for parameters that are called during the function
/// and not stored. Must not outlive the object. (A std::function owns a copy, and its header has
/// 10,000 lines.)
template <class R, class... Args>
class FunctionRef<R(Args...)> {
 public:
  FunctionRef(R (&f)(Args...))
      : object_(reinterpret_cast<void*>(&f)), call_([](void* object, Args... args) -> R {
          return reinterpret_cast<R (*)(Args...)>(object)(std::forward<Args>(args)...);
        }) {}
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
           std::is_object_v<std::remove_reference_t<F>> && std::is_invocable_r_v<R, F&, Args...>)
      FunctionRef(F&& f)
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(f)))),
        call_([](void* object, Args... args) -> R {
          return (*static_cast<std::remove_reference_t<F>*>(object))(std::forward<Args>(args)...);
        }) {}

  R operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

 private:
  void* object_;
  R (*call_)(void*, Args...);
};

}  // namespace tumble
