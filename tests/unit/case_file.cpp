// The case reader: what it reads, and the text of every refusal.
#include "proto/case/case_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/case_text.hpp"

using namespace proto;
using tests::CaseText;
using tests::error_of;

namespace {

/// Refusal of `text` by `read`, which gets section "a".
template <class Read>
std::string refusal(const std::string& text, Read read) {
  const CaseText file(text);
  return error_of([&] { read(file.load().section("a")); });
}

std::string number(const std::string& value, Range range = Range::any()) {
  return refusal("[a]\nx = " + value + "\n", [&](const Section& a) { a.number("x", range); });
}

TEST(CaseFile, reads_every_kind_of_value) {
  const CaseText file(
      "[a]\nn = 2\nx = 0.5\nb = true\nt = \"word\"\nv = [1, 2.5]\nw = [\"p\", \"q\"]\ni = [3, 4]\n[a.sub]\ny = 1\n"
      "[[list]]\nz = 1\n[[list]]\nz = 2\n");
  const auto loaded = file.load();
  const auto a = loaded.section("a");
  EXPECT_EQ(a.integer("n"), 2);
  EXPECT_EQ(a.number("n"), 2.0) << "a whole number is a number";
  EXPECT_EQ(a.number_or("x", 9), 0.5);
  EXPECT_EQ(a.number_or("none", 9), 9);
  EXPECT_TRUE(a.boolean_or("b", false));
  EXPECT_EQ(a.text("t"), "word");
  EXPECT_EQ(a.choice("t", {"word", "other"}), "word");
  EXPECT_EQ(a.numbers("v", 2), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(a.integers("i"), (std::vector<std::int64_t>{3, 4}));
  EXPECT_EQ(a.texts_or("w", {}), (std::vector<std::string>{"p", "q"}));
  EXPECT_EQ(a.section("sub").number("y"), 1);
  EXPECT_NO_THROW(a.finish());
  EXPECT_EQ(loaded.sections("list").at(1).integer("z"), 2);
  EXPECT_EQ(loaded.sections("absent").size(), 0u);
  EXPECT_EQ(loaded.section("absent").number_or("x", 3), 3);
  EXPECT_EQ(loaded.name(), file.folder().substr(5)) << "the folder's name, of a file called case.toml";
}

TEST(CaseFile, hash_is_that_of_the_bytes) {
  const CaseText one("[a]\n"), same("[a]\n"), other("[b]\n");
  EXPECT_EQ(one.load().hash(), same.load().hash());
  EXPECT_NE(one.load().hash(), other.load().hash());
}

TEST(CaseFile, an_unknown_key_names_its_place_and_the_nearest) {
  const auto read = [](const Section& a) {
    a.number_or("stiffness_n_per_m", 1);
    a.finish();
  };
  EXPECT_EQ(refusal("[a]\n\n  stifness_n_per_m = 3\n", read),
            "unknown key - case.toml:3:3: a.stifness_n_per_m - did you mean 'stiffness_n_per_m'?");
  EXPECT_EQ(refusal("[a]\ncolour = 3\n", read),
            "unknown key - case.toml:2:1: a.colour - valid keys: stiffness_n_per_m");
}

TEST(CaseFile, a_missing_key_names_what_was_found_in_its_place) {
  const auto read = [](const Section& a) { a.number("gauge_m"); };
  EXPECT_EQ(refusal("[a]\nguage_m = 3\n", read),
            "missing key 'gauge_m', found 'guage_m' - case.toml:2:1: a.guage_m - did you mean 'gauge_m'?");
  EXPECT_EQ(refusal("\n[a]\n", read), "missing key - case.toml:2:1: a.gauge_m - add it");
  EXPECT_EQ(refusal("", read), "missing key - case.toml: a.gauge_m - add it") << "no such section";
}

TEST(CaseFile, finish_looks_into_sub_tables_that_were_read_and_refuses_those_that_were_not) {
  const auto read = [](const Section& a) {
    a.section("sub").number_or("x", 1);
    for (const auto& item : a.sections("items")) item.number_or("y", 1);
    a.finish();
  };
  EXPECT_EQ(refusal("[a.sub]\nx = 1\n[[a.items]]\ny = 1\n", read), "no error");
  EXPECT_EQ(refusal("[a.sub]\nq = 1\n", read), "unknown key - case.toml:2:1: a.sub.q - did you mean 'x'?");
  EXPECT_EQ(refusal("[[a.items]]\ny = 1\n[[a.items]]\nyy = 1\n", read),
            "unknown key - case.toml:4:1: a.items.yy - did you mean 'y'?");
  EXPECT_EQ(refusal("[a.sup]\nx = 1\n", read), "unknown key - case.toml:1:4: a.sup - did you mean 'sub'?");
}

TEST(CaseFile, types_are_checked) {
  EXPECT_EQ(number("\"5\""), "a number is wanted, found a text - case.toml:2:5: a.x");
  EXPECT_EQ(number("[5]"), "a number is wanted, found an array - case.toml:2:5: a.x");
  const auto whole = [](const Section& a) { a.integer("x"); };
  EXPECT_EQ(refusal("[a]\nx = 5.0\n", whole), "a whole number is wanted, found a number - case.toml:2:5: a.x");
  const auto flag = [](const Section& a) { a.boolean_or("x", true); };
  EXPECT_EQ(refusal("[a]\nx = 1\n", flag), "true or false is wanted, found a whole number - case.toml:2:5: a.x");
  const auto list = [](const Section& a) { a.numbers("x", 3); };
  EXPECT_EQ(refusal("[a]\nx = [1, 2]\n", list), "3 numbers are wanted, found 2 - case.toml:2:5: a.x");
  EXPECT_EQ(refusal("[a]\nx = [1, true, 2]\n", list), "a number is wanted, found a boolean - case.toml:2:9: a.x[1]");
  EXPECT_EQ(refusal("[a]\nx = 1\n", list), "an array of numbers is wanted, found a whole number - case.toml:2:5: a.x");
  const auto table = [](const Section& a) { a.section("x"); };
  EXPECT_EQ(refusal("[a]\nx = 1\n", table),
            "a table is wanted, found a whole number - case.toml:2:1: a.x - write [a.x]");
  const auto tables = [](const Section& a) { a.sections("x"); };
  EXPECT_EQ(refusal("[a]\nx = [1]\n", tables), "an array of tables is wanted - case.toml:2:1: a.x - write [[a.x]]");
}

TEST(CaseFile, ranges_are_checked) {
  EXPECT_EQ(number("-3", Range::positive()), "the value must be greater than 0, found -3 - case.toml:2:5: a.x");
  EXPECT_EQ(number("0", Range::positive()), "the value must be greater than 0, found 0 - case.toml:2:5: a.x");
  EXPECT_EQ(number("-1e-9", Range::not_negative()), "the value must be at least 0, found -1e-09 - case.toml:2:5: a.x");
  EXPECT_EQ(number("1.5", Range::between(0, 1)), "the value must be between 0 and 1, found 1.5 - case.toml:2:5: a.x");
  EXPECT_EQ(number("1", Range::between(0, 1)), "no error");
}

TEST(CaseFile, numbers_are_finite) {
  EXPECT_EQ(number("nan"), "a finite number is wanted, found nan - case.toml:2:5: a.x");
  EXPECT_EQ(number("-inf"), "a finite number is wanted, found -inf - case.toml:2:5: a.x");
  EXPECT_NE(number("1e400").find("not valid TOML"), std::string::npos);
}

TEST(CaseFile, a_choice_lists_what_there_is) {
  const auto read = [](const Section& a) { a.choice_or("x", "box", {"box", "mesh"}); };
  EXPECT_EQ(refusal("[a]\nx = \"bax\"\n", read),
            "'bax' is not one of: box, mesh - case.toml:2:5: a.x - did you mean 'box'?");
}

TEST(CaseFile, a_path_starts_at_the_case_and_must_exist) {
  const CaseText file("[a]\nhere = \"case.toml\"\ngone = \"mesh.msh\"\n");
  const auto a = file.load().section("a");
  EXPECT_EQ(a.existing_path("here"), file.path());
  ExitCode code{};
  EXPECT_EQ(
      error_of([&] { a.existing_path("gone"); }, &code),
      "there is no file 'mesh.msh' - case.toml:3:1: a.gone - relative paths start at the folder of the case file");
  EXPECT_EQ(code, ExitCode::missing_input);
}

TEST(CaseFile, case_folder_is_where_relative_paths_start) {
  const CaseText original("[a]\n");
  const auto folder = original.path().substr(0, original.path().rfind('/'));
  const CaseText derived("case_folder = \"" + folder + "\"\n[a]\nhere = \"case.toml\"\n");
  EXPECT_EQ(derived.load().section("a").existing_path("here"), original.path());
  EXPECT_EQ(derived.load().section("a").matching_files("here", {".toml"}), std::vector<std::string>{original.path()});
  derived.load().refuse_unknown_sections({"a"});
  for (const char* value : {"\"relative\"", "3"}) {
    const CaseText wrong(std::string("case_folder = ") + value + "\n");
    EXPECT_EQ(error_of([&] { wrong.load(); }),
              "an absolute path is wanted - case.toml:1:15: case_folder - remove it: relative paths start at the file");
  }
}

TEST(CaseFile, unknown_sections_are_refused) {
  const CaseText file("[track]\n[couplin]\n");
  EXPECT_EQ(error_of([&] {
              file.load().refuse_unknown_sections({"track", "coupling"});
            }),
            "unknown section - case.toml:2:2: couplin - did you mean 'coupling'?");
}

TEST(CaseFile, a_file_that_is_none_is_missing_input) {
  ExitCode code{};
  EXPECT_EQ(error_of([] { CaseFile::load("/tmp/qf-case-nobody/case.toml"); }, &code).substr(0, 26),
            "there is no such case file");
  EXPECT_EQ(code, ExitCode::missing_input);
  EXPECT_EQ(error_of([] { CaseFile::load("/dev/zero"); }, &code).substr(0, 22), "the case is not a file");
}

TEST(CaseFile, syntax_errors_have_a_place) {
  EXPECT_EQ(number("[1").substr(0, 45), "the case file is not valid TOML: Error while ");
  EXPECT_NE(number("1\nx = 2").find("case.toml:3:"), std::string::npos) << "a repeated key";
}

TEST(CaseFile, hostile_files_are_refused_before_the_parser_sees_them) {
  std::string key;
  for (int i = 0; i < 200000; ++i) key += "a.";
  EXPECT_EQ(refusal(key + "a = 1\n", [](const Section&) {}), "a key of more than 64 dotted parts - case.toml:1:128");
  EXPECT_EQ(refusal("[" + key + "a]\n", [](const Section&) {}), "a key of more than 64 dotted parts - case.toml:1:129");
  EXPECT_EQ(refusal("x = " + std::string(1000, '['), [](const Section&) {}),
            "brackets nested deeper than 64 - case.toml:1:69");
  EXPECT_EQ(refusal("# " + std::string(2 << 20, ' '), [](const Section&) {}),
            "the case file is larger than 1 MiB - case.toml - put tables into files of their own");
  const std::string harmless(200, '.');
  EXPECT_EQ(
      refusal("[a]\nx = \"" + harmless + "\" # " + harmless + "\ny = '''" + harmless + "'''\n", [](const Section&) {}),
      "no error");
}

TEST(EditDistance, counts_insertions_deletions_and_substitutions) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("gauge", "guage"), 2);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(nearest_name("zebra", std::vector<std::string>{"horse", "zabra"}), "zabra");
  EXPECT_EQ(nearest_name("zebra", std::vector<std::string>{"elephant"}), "") << "more than three edits away";
}

}  // namespace
