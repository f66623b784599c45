// Ownership of HDF5 identifiers, and the text of HDF5's errors. Internal to this folder.
#pragma once

#include <hdf5.h>

#include <string>
#include <utility>

namespace proto::hdf5 {

/// Silences HDF5's own error printing and its exit handler (which would write to files that failed). Idempotent; every
/// entry into this folder calls it before its first HDF5 call.
void start_library();

/// The reason of the last failed call in a person's words: the system's error text if there is one, else HDF5's.
std::string last_error();

/// Owns one identifier. Negative identifiers (failed calls) are held as "empty".
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_), std::swap(closer_, other.closer_);
    return *this;
  }
  ~Handle() { close(); }

  explicit operator bool() const { return id_ >= 0; }
  hid_t id() const { return id_; }
  /// Closes now; false if HDF5 reports a failure.
  bool close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || closer_(id) >= 0;
  }
  /// Forgets the identifier without closing it: nothing is written any more.
  void abandon() { id_ = -1; }

 private:
  hid_t id_ = -1;
  Closer closer_ = nullptr;
};

/// Properties for creating a file, group or dataset. Equal runs give equal bytes: HDF5 would otherwise store the time
/// of creation with every object.
Handle timeless(hid_t property_class);

/// Properties that make missing groups on the way to a new object.
Handle with_groups();

}  // namespace proto::hdf5
