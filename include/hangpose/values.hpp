// What the calls of hangpose.hpp take and give: views of someone else's elements, memory, and results that
// cannot be overlooked.
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

// Elements of someone else's, as std::span has them: made of anything contiguous with data() and size(), of
// an array, or of a pointer and a count.
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

// Why a call gave nothing: what hangpose_detail says.
class error {
 public:
  error() noexcept : detail_() { detail_.struct_size = sizeof detail_; }

  hangpose_status status() const noexcept { return detail_.status; }
  // What is wrong and how to mend it.
  const char *message() const noexcept { return detail_.message; }
  // The argument or field that is wrong, or "".
  const char *field() const noexcept { return detail_.field; }
  // Index, value and range, where there are such.
  const hangpose_detail &detail() const noexcept { return detail_; }

  // For calls of hangpose.h.
  hangpose_detail *out() noexcept { return &detail_; }
  // For what goes wrong on this side.
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

// A value or the reason why there is none. To ask for the value where there is none ends the program.
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
  // Where there is a value, says that all went well.
  const class error &error() const noexcept { return error_; }

 private:
  void need() const noexcept {
    if (!has_value()) std::abort();
  }

  std::optional<T> value_;
  class error error_;
};

// Nothing but that all went well.
struct done {};

// Bytes for models and work: one's own from the heap, or the caller's, which must outlive what is made in
// them.
class memory {
 public:
  memory() noexcept = default;
  // The caller's.
  memory(void *data, std::size_t size) noexcept : data_(data), size_(size) {}
  // One's own; data() is null where there are not so many left.
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
