#pragma once

#include <hdf5.h>

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "clog/store/output_path.hpp"

/// Classes that own HDF5 identifiers, and functions for files. Only src/store includes this header.
namespace clog::store {

/// Owns one HDF5 identifier and closes it with the function of its kind.
template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  explicit Handle(hid_t id = -1) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) Close(id_);
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
};

using File = Handle<H5Fclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using PropertyList = Handle<H5Pclose>;
using Group = Handle<H5Gclose>;

/// Call this before the first use of the library. It turns off the library's clean-up at exit, which crashes
/// after a failed write, and the printing of its error stack, because we print one line instead. The library
/// need not lock files, because it has all files in memory.
void prepare_library();

/// Checks that there is enough memory for a file that the library reads or writes in memory, because the
/// library may crash if memory runs out.
/// @param purpose  as in "read sweep.h5"
/// @param size  size of the file [bytes]
/// @throws Error if there is not enough memory
void require_memory_of_file(const std::string& purpose, std::size_t size, int copies = 2);

/// Thrown when a call of the library on data in memory fails.
class LibraryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Builds a file of the earliest format in memory, writes it as a draft with a seal at its end, and publishes
/// it (see Draft::publish()).
/// @param fill  may throw LibraryError.
/// @throws Error naming the path
std::optional<std::string> write_whole(const OutputPath& place, const std::string& stamp,
                                       const std::function<void(hid_t file)>& fill);

/// The content of a regular file. @throws Error that says what is wrong with the path
std::vector<std::byte> read_file(const std::string& path);
/// Opens the bytes of a file for reading, so that the library reads exactly the checked bytes. `image` must
/// outlive the result. @throws Error naming the path if the bytes are not an HDF5 file
File open_image(std::vector<std::byte>& image, const std::string& path);

Space space_of(std::initializer_list<hsize_t> shape);
/// Properties of a dataset with chunks of this many rows. The chunks have checksums, with which other
/// programs detect damage.
PropertyList checked_chunks(hsize_t num_rows);
/// Properties for reading without the library's check of checksums. Our checksums identify damaged rows, so
/// the library should return all data.
PropertyList without_library_check();
/// Creates and fills a dataset; attributes can be added to the result. @throws LibraryError
/// @param data  nullptr: the data are written later
Dataset write_dataset(hid_t parent, const std::string& name, hid_t type, hid_t space, const void* data,
                      hid_t properties = H5P_DEFAULT);
/// Number of elements of a list; nullopt for a dataset of another shape.
std::optional<hsize_t> length_of(hid_t dataset);
/// Whether a dataset can hold this number of elements of this size.
bool can_hold(hid_t dataset, hsize_t number, std::size_t bytes_each);

/// Fixed-length, zero-padded text; the length is at least 1.
Type text_type(std::size_t length);
/// Names of the objects in a group.
std::vector<std::string> names_in(hid_t group);
/// Names of the attributes of an object.
std::vector<std::string> attributes_of(hid_t object);
/// Name of a member of a compound type; empty if there is no member with this index.
std::string member_name(hid_t type, unsigned index);
/// @throws LibraryError
void write_attribute(hid_t object, const std::string& name, const std::string& text);
/// The attribute's text. Empty if there is no such attribute, or if it is not a text of fixed length.
std::string read_attribute(hid_t object, const std::string& name);

}  // namespace clog::store
