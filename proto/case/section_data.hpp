// What a Section and a CaseFile hold; private to this folder (the only one that sees toml++).
#pragma once

#include <toml++/toml.h>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"

namespace proto {

/// The parsed file, kept alive by every section of it.
struct CaseDocument {
  std::string path;
  std::string folder;  ///< that relative paths start from, absolute
  std::string text;
  toml::table root;
};

struct Section::Data {
  std::shared_ptr<const CaseDocument> document;
  const toml::table* table = nullptr;  ///< null: the file has no such section
  std::string name;                    ///< dotted path from the root, "" for the root itself

  std::set<std::string> asked;  ///< every key that somebody read or offered to read
  std::map<std::string, std::shared_ptr<Data>> tables;
  std::map<std::string, std::vector<std::shared_ptr<Data>>> arrays;

  const toml::node* find(const std::string& key) const { return table ? table->get(key) : nullptr; }
  /// Sub-table `key`, made on the first request and shared by later ones.
  std::shared_ptr<Data> child(const std::string& key);
  const std::vector<std::shared_ptr<Data>>& children(const std::string& key);
  std::string full_name(const std::string& key) const { return name.empty() ? key : name + "." + key; }
  /// "FILE:LINE:COLUMN: section.key"; without line and column where `region` has none.
  std::string where(const toml::source_region& region, const std::string& key) const;
  /// Place of a key: its own text where the file has it, else the head of its section.
  std::string where(const std::string& key) const;
};

}  // namespace proto
