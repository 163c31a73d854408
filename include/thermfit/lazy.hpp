#pragma once

namespace thermfit {

namespace detail {
template <class Type, typename Scalar>
struct LazyType {
  using type = Type;
};
}  // namespace detail

/// `Type` itself, in a template on `Scalar`.
///
/// A compiler instantiates every matrix expression that does not depend on a template parameter, used or not. What is
/// reached through a Lazy does depend on one: naming plain data so makes a template cost nothing until it is called.
/// Never deduced, so that arguments convert to it as to `Type`.
template <class Type, typename Scalar = double>
using Lazy = typename detail::LazyType<Type, Scalar>::type;

}  // namespace thermfit
