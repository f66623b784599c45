// Text files of two columns of numbers.
#pragma once

#include <string>
#include <vector>

namespace fem {

/// The rows of a file with two numbers a line, comma or blank between; `#` starts a comment, empty lines are skipped.
class TwoColumns {
 public:
  struct Row {
    double first, second;
    int line;  ///< in the file, from 1
  };

  /// `what`: the file's content, `columns`: their names, for messages. Throws proto::Error: missing_input, or bad_data
  /// with the line that is not two finite numbers.
  TwoColumns(const std::string& path, const std::string& what, const std::string& columns);

  const std::vector<Row>& rows() const { return rows_; }

  /// Throws proto::Error (bad_data) with the line where the first column does not ascend, or for fewer than two rows.
  void require_ascending() const;

 private:
  std::string path_, what_, columns_;
  std::vector<Row> rows_;
};

}  // namespace fem
