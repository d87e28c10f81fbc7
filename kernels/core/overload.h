// One function object out of several, for std::visit.
#pragma once

namespace sherd {

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;

}  // namespace sherd
