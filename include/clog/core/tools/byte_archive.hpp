#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace clog {

/// Writes plain values one after the other, in their form in memory. Only the same program on a machine of
/// the same kind can read the bytes.
class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  void put(const Eigen::ArrayXd& values) {
    put(static_cast<std::size_t>(values.size()));
    append(values.data(), static_cast<std::size_t>(values.size()) * sizeof(double));
  }
  void put(const Eigen::Array2d& value) { append(value.data(), sizeof(double) * 2); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  void append(const void* from, std::size_t size) {
    const std::size_t old_size = bytes_.size();
    bytes_.resize(old_size + size);
    if (size > 0) std::memcpy(bytes_.data() + old_size, from, size);
  }
};

/// Reads the values that a ByteWriter wrote, in the order of writing. @throws std::out_of_range at the end of
/// the bytes
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    extract(&value, sizeof value);
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(get_size(sizeof(T)));
    extract(values.data(), values.size() * sizeof(T));
  }
  void get(Eigen::ArrayXd& values) {
    values.resize(static_cast<Eigen::Index>(get_size(sizeof(double))));
    extract(values.data(), static_cast<std::size_t>(values.size()) * sizeof(double));
  }
  void get(Eigen::Array2d& value) { extract(value.data(), sizeof(double) * 2); }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
  void extract(void* to, std::size_t size) {
    if (size > rest_.size()) throw std::out_of_range("bytes end too early");
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::size_t get_size(std::size_t element) {
    std::size_t size = 0;
    get(size);
    if (size > rest_.size() / element) throw std::out_of_range("bytes end too early");
    return size;
  }
};

}  // namespace clog
