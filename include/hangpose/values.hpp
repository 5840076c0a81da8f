// The argument and result types of hangpose.hpp: views of the caller's arrays, memory, errors and
// [[nodiscard]] results.
#ifndef HANGPOSE_VALUES_HPP
#define HANGPOSE_VALUES_HPP

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "hangpose.h"

namespace hangpose {

// A view of contiguous elements that it does not own, like std::span: made from a container with data() and
// size(), from an array, or from a pointer and a count.
template <class T>
class view {
 public:
  constexpr view() noexcept = default;
  constexpr view(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
  template <std::size_t N>
  constexpr view(T (&array)[N]) noexcept : data_(array), size_(N) {}
  template <class Container,
            class = std::enable_if_t<std::is_convertible_v<
                std::remove_pointer_t<decltype(std::declval<Container &>().data())> (*)[], T (*)[]>>,
            class = decltype(std::declval<Container &>().size())>
  constexpr view(Container &&container) noexcept : data_(container.data()), size_(container.size()) {}

  constexpr T *data() const noexcept { return data_; }
  constexpr std::size_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr T *begin() const noexcept { return data_; }
  constexpr T *end() const noexcept { return data_ + size_; }
  constexpr T &operator[](std::size_t index) const noexcept { return data_[index]; }

 private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

// Reason why a call failed: a hangpose_detail.
class error {
 public:
  error() noexcept : detail_() { detail_.struct_size = sizeof detail_; }

  hangpose_status status() const noexcept { return detail_.status; }
  // A sentence for people: what is wrong and how to correct it.
  const char *message() const noexcept { return detail_.message; }
  // Name of the wrong argument or field, or "".
  const char *field() const noexcept { return detail_.field; }
  // The whole detail, with the index, the value and its range.
  const hangpose_detail &detail() const noexcept { return detail_; }

  // The `detail` argument for functions of hangpose.h.
  hangpose_detail *out() noexcept { return &detail_; }
  // An error that is found in the C++ wrapper.
  static error of(hangpose_status status, const char *field, const char *message) noexcept {
    error made;
    made.detail_.status = status;
    made.detail_.index = HANGPOSE_NO_INDEX;
    copy(made.detail_.field, field);
    copy(made.detail_.message, message);
    return made;
  }

 private:
  template <std::size_t N>
  static void copy(char (&to)[N], const char *from) noexcept {
    std::size_t used = 0;
    for (; used + 1 < N && from[used] != '\0'; ++used) to[used] = from[used];
    to[used] = '\0';
  }

  hangpose_detail detail_;
};

// A value, or the reason why there is none. Access to a missing value calls std::abort.
template <class T>
class [[nodiscard]] result {
 public:
  result(T &&value) noexcept : value_(std::move(value)) {}
  result(const class error &why) noexcept : error_(why) {}

  bool has_value() const noexcept { return value_.has_value(); }
  explicit operator bool() const noexcept { return has_value(); }
  T &value() &noexcept { return need(), *value_; }
  const T &value() const &noexcept { return need(), *value_; }
  T &&value() &&noexcept { return need(), *std::move(value_); }
  T &operator*() &noexcept { return value(); }
  const T &operator*() const &noexcept { return value(); }
  T &&operator*() &&noexcept { return std::move(*this).value(); }
  T *operator->() noexcept { return &value(); }
  const T *operator->() const noexcept { return &value(); }
  // The error; if there is a value, its status is HANGPOSE_OK.
  const class error &error() const noexcept { return error_; }

 private:
  void need() const noexcept {
    if (!has_value()) std::abort();
  }

  std::optional<T> value_;
  class error error_;
};

// The value of a call that succeeded and returns nothing.
struct done {};

// Memory for models and work: owned, from the heap, or the caller's, which must outlive the model created in
// it.
class memory {
 public:
  memory() noexcept = default;
  // Memory of the caller.
  memory(void *data, std::size_t size) noexcept : data_(data), size_(size) {}
  // Owned memory from the heap; data() is null if the heap has too little.
  static memory own(std::size_t size) noexcept {
    memory made;
    made.own_.reset(new (std::nothrow) unsigned char[size]);
    made.data_ = made.own_.get();
    made.size_ = made.data_ == nullptr ? 0 : size;
    return made;
  }
  void *data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }

 private:
  std::unique_ptr<unsigned char[]> own_;
  void *data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace hangpose

#endif  // HANGPOSE_VALUES_HPP
