// CURVE keys of connections that leave this machine: who needs them, and the files that hold them.
//
// The files are those of CZMQ and pyzmq (`zmq.auth.load_certificate` reads them): NAME.key holds the public key,
// NAME.key_secret both. Keys are 40 characters of Z85.
#pragma once

#include <string>

namespace proto {

struct KeyPair {
  std::string public_key, secret_key;
};

/// Whether a connection to `address` can be seen or made by others than this machine: everything but ipc://, inproc://
/// and tcp://127.x.x.x.
bool needs_keys(const std::string& address);

/// A fresh pair. Throws proto::Error (os_error) when libzmq was built without CURVE.
KeyPair make_key_pair();

/// Writes `folder`/NAME.key (mode 0644) and `folder`/NAME.key_secret (0600). Existing ones are not touched.
/// Throws proto::Error (cannot_create).
void write_key_pair(const std::string& folder, const std::string& name, const KeyPair& keys);

/// Reads the public key of either file. Throws proto::Error (missing_input, bad_data).
std::string read_public_key(const std::string& path);

/// Reads a NAME.key_secret. Throws proto::Error: missing_input; bad_data for a file that belongs to somebody else, that
/// others may read, that holds no key, or whose two keys do not belong together.
KeyPair read_key_pair(const std::string& path);

/// Writes a file of mode 0600 that is whole when it appears under its name; one that was there is replaced.
/// Throws proto::Error (cannot_create).
void write_private_file(const std::string& path, const std::string& text);

}  // namespace proto
