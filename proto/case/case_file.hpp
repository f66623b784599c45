// Reading a case file (TOML): strict, typed, with the place of every error.
//
// Every number's unit is in its key (`stiffness_n_per_m`). A key that no one asked for is an error that names the
// nearest valid key; so is a wrong type, a value out of range, NaN or infinity, and a missing key without a default.
// All errors are proto::Error with ExitCode::config (ExitCode::missing_input when the file is not there) and a text
// "problem - FILE:LINE:COLUMN: section.key - what to do".
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace proto {

/// Closed interval a number must lie in; `positive()` excludes zero.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool lowest_excluded = false;
  static Range any() { return {}; }
  static Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  static Range not_negative() { return {0.0}; }
  static Range between(double lowest, double highest) { return {lowest, highest}; }
};

/// Ending of a file's name with its dot, in small letters: ".stl".
std::string file_ending(const std::string& path);

class CaseFile;

/// One table of the case file. Reading a key marks it as known; `finish()` refuses what was never read.
/// A copy shares the marks. A section that the file lacks is empty: its defaults apply and its required keys are
/// missing.
class Section {
 public:
  bool has(const std::string& key) const;

  double number(const std::string& key, Range range = Range::any()) const;  ///< required
  double number_or(const std::string& key, double fallback, Range range = Range::any()) const;
  std::int64_t integer(const std::string& key, Range range = Range::any()) const;
  std::int64_t integer_or(const std::string& key, std::int64_t fallback, Range range = Range::any()) const;
  bool boolean_or(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;
  /// A text that must be one of `choices`; the message lists them and names the nearest.
  std::string choice(const std::string& key, const std::vector<std::string>& choices) const;
  std::string choice_or(const std::string& key, const std::string& fallback,
                        const std::vector<std::string>& choices) const;
  /// Numbers; `length` = 0 accepts any length.
  std::vector<double> numbers(const std::string& key, std::size_t length = 0, Range range = Range::any()) const;
  std::vector<double> numbers_or(const std::string& key, const std::vector<double>& fallback,
                                 Range range = Range::any()) const;
  std::vector<std::int64_t> integers(const std::string& key, std::size_t length = 0, Range range = Range::any()) const;
  std::vector<std::string> texts_or(const std::string& key, const std::vector<std::string>& fallback) const;

  /// A path as written, relative paths resolved against the folder of the case file, or against the one that its
  /// top-level key `case_folder` names. Throws missing_input if there is no such file.
  std::string existing_path(const std::string& key) const;

  /// Files that the text of a required key names, ascending by name: one file, all files of a folder that have one of
  /// `endings` (".stl", in small letters; the case in the name does not matter), or those that match * and ? in the
  /// last part of the path. Relative paths as in existing_path(). Throws missing_input where there is none, config for
  /// a file with another ending that is not in a folder named as such.
  std::vector<std::string> matching_files(const std::string& key, const std::vector<std::string>& endings) const;

  Section section(const std::string& key) const;                ///< sub-table, empty if absent
  std::vector<Section> sections(const std::string& key) const;  ///< array of tables, empty if absent

  /// Throws for the first key that nobody read, naming the nearest one that somebody asked for. Recurses into the
  /// sub-tables that were read; a sub-table that nobody read is itself such a key.
  void finish() const;

  /// Throws a config error about `key` of this section: "problem - FILE:LINE:COL: section.key - advice".
  [[noreturn]] void fail(const std::string& key, const std::string& problem, const std::string& advice = {}) const;

  struct Data;

 private:
  friend class CaseFile;
  explicit Section(std::shared_ptr<Data> data);
  std::shared_ptr<Data> data_;
};

/// A loaded case file. Cheap to copy.
class CaseFile {
 public:
  /// Reads and parses `path`. Refuses a file above 1 MiB and keys of more than 64 dotted parts.
  static CaseFile load(const std::string& path);

  Section section(const std::string& name) const;
  std::vector<Section> sections(const std::string& name) const;

  const std::string& path() const;  ///< absolute
  const std::string& text() const;  ///< the file's bytes, kept for the record
  std::string name() const;         ///< folder name of `case.toml`, else the file's stem
  std::uint64_t hash() const;       ///< XXH3-64 of the bytes

  /// One line for every key whose value differs or that only one of the files has: "coupling.window_s: 5e-05 ->
  /// 0.0001", "bed.seed: 1 -> (none)". In order of the keys. Comments, order and layout do not count.
  std::vector<std::string> differences_to(const CaseFile& later) const;

  /// Throws for a top-level section that is in none of `known`, naming the nearest.
  void refuse_unknown_sections(const std::vector<std::string>& known) const;

 private:
  explicit CaseFile(std::shared_ptr<Section::Data> root);
  std::shared_ptr<Section::Data> root_;
};

}  // namespace proto
