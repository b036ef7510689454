#include "catch.hpp"
#include "files.hpp"

#include <dem/io/csv.hpp>
#include <dem/io/csv_table.hpp>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using dem::io::csv_quote;
using dem::io::CsvWriter;
using dem::io::read_file;

TEST_CASE("csv text is quoted as RFC 4180 says") {
  CHECK(csv_quote("plain text") == "plain text");
  CHECK(csv_quote("") == "");
  CHECK(csv_quote("a,b") == "\"a,b\"");
  CHECK(csv_quote("a;b") == "a;b");
  CHECK(csv_quote("a;b", ';') == "\"a;b\"");
  CHECK(csv_quote("say \"no\"") == "\"say \"\"no\"\"\"");
  CHECK(csv_quote("two\nlines") == "\"two\nlines\"");
  CHECK(csv_quote(" outer") == "\" outer\"");
}

TEST_CASE("csv rows follow a header") {
  const TempFolder folder;
  CsvWriter csv(folder / "new/deep/shear.csv", {"time_s", "stress, total_Pa", "packing", "grains", "settled"});
  csv.row(0.1, 101325.0, "loose", 14256, true);
  csv.row(0.2F, -1e-30, std::string("dense, wet"), std::size_t{7}, false);
  csv.flush();
  CHECK(csv.rows() == 2);
  CHECK(read_file(csv.path()) ==
        "time_s,\"stress, total_Pa\",packing,grains,settled\n"
        "0.1,101325,loose,14256,1\n"
        "0.2,-1e-30,\"dense, wet\",7,0\n");
}

TEST_CASE("csv numbers read back as the same numbers") {
  const TempFolder folder;
  const std::vector<double> values{1.0 / 3,
                                   0.1 + 0.2,
                                   6.02214076e23,
                                   std::numeric_limits<double>::denorm_min(),
                                   -std::numeric_limits<double>::max(),
                                   1e15,
                                   123456789012345678.0};
  CsvWriter csv(folder / "a.csv", {"a", "b", "c", "d", "e", "f", "g"});
  csv.row(values);
  csv.flush();
  std::string text = read_file(csv.path());
  text.erase(0, text.find('\n') + 1);
  const char* at = text.c_str();
  for (const double value : values) {
    char* end = nullptr;
    CHECK(std::strtod(at, &end) == value);
    at = end + 1;
  }
}

TEST_CASE("csv digits, separator and odd numbers") {
  const TempFolder folder;
  CsvWriter csv(folder / "a.csv", {"a", "b", "c"}, {.digits = 4, .separator = ';'});
  csv.row(1.0 / 3, std::nan(""), -std::numeric_limits<double>::infinity());
  csv.row(std::copysign(std::nan(""), -1.0), -std::nanf(""), 1);
  csv.flush();
  CHECK(read_file(csv.path()) == "a;b;c\n0.3333;nan;-inf\nnan;nan;1\n");
}

TEST_CASE("csv rows are on disk while the writer still lives") {
  const TempFolder folder;
  CsvWriter at_once(folder / "a.csv", {"a"}, {.flush_s = 0});
  at_once.row(1);
  CHECK(read_file(folder / "a.csv") == "a\n1\n");
  const CsvWriter header_only(folder / "b.csv", {"b"});
  CHECK(read_file(folder / "b.csv") == "b\n");
}

TEST_CASE("a table of numbers is read back as it was written, and one that is none is refused with the line") {
  const TempFolder folder;
  {
    CsvWriter csv(folder / "t.csv", {"time_s", "force_N"});
    csv.row(0.1, -1.0 / 3.0);
    csv.row(1e-300, std::numeric_limits<double>::infinity());
  }
  const auto table = dem::io::read_csv(folder / "t.csv");
  REQUIRE(table.rows.size() == 2);
  CHECK(table.column("force_N") == 1);
  CHECK(table.rows[0][1] == -1.0 / 3.0);
  CHECK(table.rows[1] == std::vector{1e-300, std::numeric_limits<double>::infinity()});
  const auto read = [&](const char* text) {
    dem::io::write_file(folder / "bad.csv", text);
    return dem::io::read_csv(folder / "bad.csv");
  };
  // Spaces, a plus, line ends of Windows and empty lines, as tables of other programs have them.
  const auto other = read(" a , b\r\n\r\n +1 ,\t2\r\n");
  CHECK(other.columns == std::vector<std::string>{"a", "b"});
  CHECK(other.rows == std::vector<std::vector<double>>{{1.0, 2.0}});
  CHECK(read("").rows.empty());
  CHECK(read("\xEF\xBB\xBFtime_s\n1\n").column("time_s") == 0);  // as spreadsheets write it
  using Catch::Matchers::ContainsSubstring;
  CHECK_THROWS_WITH(other.column("c"), ContainsSubstring("has no column 'c', but has a, b"));
  CHECK_THROWS_WITH(read("a,b,a\n"), ContainsSubstring("has two columns 'a'"));
  CHECK_THROWS_WITH(read("a,b\n\n1,x\n"), ContainsSubstring("line 3, column b: 'x' is no number"));
  CHECK_THROWS_WITH(read("a,b\n1,\n"), ContainsSubstring("'' is no number"));
  CHECK_THROWS_WITH(read("a,b\n1\n"), ContainsSubstring("line 2: 1 numbers, but there are 2 columns"));
  CHECK_THROWS_WITH(read("a\n1,2\n"), ContainsSubstring("line 2: 2 numbers, but there are 1 columns"));
}

TEST_CASE("names of columns that hold commas, quotes and line ends are read back") {
  const TempFolder folder;
  const std::vector<std::string> names{"slip, mean", "the \"rut\"", "two\nlines", " outer", "5\" pipe", "\"", "plain"};
  {
    CsvWriter csv(folder / "t.csv", names);
    csv.row(std::vector<double>{1, 2, 3, 4, 5, 6, 7});
    csv.close();
  }
  const auto table = dem::io::read_csv(folder / "t.csv");
  CHECK(table.columns == names);
  CHECK(table.rows == std::vector<std::vector<double>>{{1, 2, 3, 4, 5, 6, 7}});
  // Of other programs: quotes within a name, and spaces around quotes.
  dem::io::write_file(folder / "t.csv", "5\" pipe, \"a, b\" ,c\r\n1,2,3\r\n");
  CHECK(dem::io::read_csv(folder / "t.csv").columns == std::vector<std::string>{"5\" pipe", "a, b", "c"});
  dem::io::write_file(folder / "t.csv", "a,\"b\n1,2\n");
  CHECK(error_of([&] { (void)dem::io::read_csv(folder / "t.csv"); }).find("begins with a quote, but does not end") !=
        std::string::npos);
}

TEST_CASE("a csv file goes on after a time, whatever an earlier run wrote later") {
  const TempFolder folder;
  const auto path = folder / "force.csv";
  const auto write = [&](double from, double to, dem::io::CsvOptions options) {
    CsvWriter csv(path, {"time_s", "force_N"}, options);
    for (double t = from; t < to; t += 0.125) csv.row(t, 2 * t);
    return csv.rows();
  };
  CHECK(write(0, 1, {.goes_on_after = 0.5}) == 8);  // there is none yet
  const std::string whole = read_file(path);
  CHECK(write(0.625, 1, {.goes_on_after = 0.5}) == 8);
  CHECK(read_file(path) == whole);

  // A row that was cut off as the run was killed goes as well.
  dem::io::write_file(path, whole.substr(0, whole.size() - 2));
  CHECK(write(0.875, 1, {.goes_on_after = 5}) == 8);
  CHECK(read_file(path) == whole);

  // Rounded cells are compared with what the time would be rounded to.
  write(0, 1, {.digits = 1});
  CHECK(write(0.75, 1, {.digits = 1, .goes_on_after = 0.625}) == 8);

  // Steps, which are not rounded, and texts with line ends.
  const auto count = [&](int from, int to, double after) {
    CsvWriter csv(folder / "steps.csv", {"step", "note"}, {.digits = 3, .goes_on_after = after});
    for (int k = from; k < to; k += 10) csv.row(k, "a\n5 b");
    return csv.rows();
  };
  CHECK(count(12300, 12400, 0.0) == 10);
  CHECK(count(12350, 12400, 12340) == 10);
  CHECK(count(0, 0, 12345) == 5);

  CHECK(error_of([&] {
          CsvWriter(path, {"time_s", "pull_N"}, {.goes_on_after = 0});
        }) == "csv file '" + path.string() +
                  "' cannot go on: its columns are 'time_s,force_N', not 'time_s,pull_N'; give it another name, or "
                  "move it away");
  dem::io::write_file(path, "time_s,force_N\r\n0,1\r\n");
  CHECK(error_of([&] {
          CsvWriter(path, {"time_s", "force_N"}, {.goes_on_after = 0});
        }) == "csv file '" + path.string() +
                  "' cannot go on: its lines end with CR LF, not LF; convert it, or give it another name");
  CHECK(read_file(path) == "time_s,force_N\r\n0,1\r\n");
  dem::io::write_file(path, "time_s,force_N\nsand,1\n");
  CHECK(error_of([&] {
          CsvWriter(path, {"time_s", "force_N"}, {.goes_on_after = 0});
        }) == "csv file '" + path.string() + "' cannot go on: its row 'sand,1' does not begin with a number");
  CHECK(read_file(path) == "time_s,force_N\nsand,1\n");
  dem::io::write_file(path, "time_s,force_N\nnan,1\n");
  CHECK(error_of([&] {
          CsvWriter(path, {"time_s", "force_N"}, {.goes_on_after = 0});
        }) == "csv file '" + path.string() + "' cannot go on: its row 'nan,1' does not begin with a number");
}

TEST_CASE("csv mistakes are told") {
  const TempFolder folder;
  const std::string path = (folder / "a.csv").string();
  CHECK(error_of([&] { CsvWriter(path, {}); }) ==
        "csv file '" + path + "': no columns; name at least one, e.g. \"time_s\"");
  CHECK(error_of([&] {
          CsvWriter(path, {"a", ""});
        }) == "csv file '" + path + "': column 1 has an empty name; name it, with its unit");
  CHECK(error_of([&] {
          CsvWriter(path, {"a", "b", "a"});
        }) == "csv file '" + path + "': the column 'a' is named twice; rename one");
  CsvWriter csv(path, {"a", "b"});
  const std::string too_long =
      "csv file '" + path + "': a row has 3 cells, but there are 2 columns (a, b); give one cell a column";
  CHECK(error_of([&] { csv.row(1, 2, 3); }) == too_long);
  CHECK(error_of([&] { csv.row(std::vector<double>{1, 2, 3}); }) == too_long);
  CHECK(csv.rows() == 0);
}

TEST_CASE("a file that cannot be opened or read is told") {
  const TempFolder folder;
  const std::string path = folder.path().string();
  CHECK(error_of([&] { CsvWriter(path, {"a"}); }) ==
        "cannot open '" + path + "' for writing (Is a directory); choose a path that you may write to");
  dem::io::write_file(folder / "file", "");
  CHECK_THAT(error_of([&] { CsvWriter(folder / "file/a.csv", {"a"}); }),
             Catch::Matchers::StartsWith("cannot make the folder '" + path + "/file' ("));
  CHECK(error_of([&] { (void)read_file(folder / "none"); }) ==
        "cannot read the file '" + path + "/none'; check that it exists and may be read");
}

TEST_CASE("a full disk is told") {
  if (!std::filesystem::exists("/dev/full")) return;
  CHECK(error_of([] { CsvWriter("/dev/full", {"a"}); }) ==
        "cannot write to '/dev/full' (No space left on device); check that the disk is not full");
}

namespace {

/// What a process that runs `call`, and may write files of a thousand bytes only, says on stderr.
template <class Call>
std::string words_of(Call&& call) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    ::dup2(ends[1], STDERR_FILENO);
    call();
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string words;
  char letter = 0;
  while (::read(ends[0], &letter, 1) == 1) words += letter;
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 0));
  return words;
}

}  // namespace

TEST_CASE("rows that a full disk does not take are not lost without a word") {
  const TempFolder folder;
  const auto path = folder / "rows.csv";
  const auto write = [&](CsvWriter& csv) {
    for (int k = 0; k < 300; ++k) csv.row(k, 0.5 * k);
  };
  const std::string warning =
      "warning: the end of '" + path.string() + "' is lost (File too large); check that the disk is not full\n";
  CHECK(words_of([&] {
          CsvWriter csv(path, {"row", "half"});
          write(csv);
        }) == warning);
  CHECK(std::filesystem::file_size(path) == 1000);
  // Also while another exception is on its way.
  CHECK(words_of([&] {
          try {
            CsvWriter csv(path, {"row", "half"});
            write(csv);
            throw 1;
          } catch (int) {
          }
        }) == warning);
  // What was thrown is not told again.
  const std::string thrown =
      "cannot write to '" + path.string() + "' (File too large); check that the disk is not full";
  CHECK(words_of([&] {
          CsvWriter csv(path, {"row", "half"});
          write(csv);
          if (error_of([&] { csv.close(); }) != thrown) ::_exit(1);
          csv.close();  // it is
        }).empty());
  CHECK(words_of([&] {
          CsvWriter csv(path, {"row", "half"});
          write(csv);
          if (error_of([&] { csv.flush(); }) != thrown) ::_exit(1);
        }).empty());
  // A file that was not meant to stay.
  CHECK(words_of([&] {
          dem::io::AtomicFile file(path);
          file.write(std::string(2000, 'x'));
        }).empty());

  CsvWriter csv(path, {"row", "half"});
  write(csv);
  csv.close();
  CHECK(dem::io::read_csv(path).rows.size() == 300);
  CHECK_THAT(error_of([&] { csv.row(1, 2); }), Catch::Matchers::Contains("it was closed"));
}

TEST_CASE("a link stays, and what it leads to is written") {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "there");
  dem::io::write_file(folder / "there/a.txt", "old");
  std::filesystem::create_symlink("there/a.txt", folder / "link");
  std::filesystem::create_symlink(folder / "link", folder / "second");
  std::filesystem::create_symlink("there/new.txt", folder / "to_none");
  dem::io::write_file(folder / "second", "new");
  dem::io::write_file(folder / "to_none", "first");
  CHECK(read_file(folder / "there/a.txt") == "new");
  CHECK(read_file(folder / "there/new.txt") == "first");
  for (const char* link : {"link", "second", "to_none"}) CHECK(std::filesystem::is_symlink(folder / link));
  { dem::io::AtomicFile(folder / "link").write("half"); }
  CHECK(read_file(folder / "link") == "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder / "there"), {}) == 2);
  // Links in a circle lead to nothing, and stay as they are.
  std::filesystem::create_symlink("circle", folder / "circle");
  CHECK_THAT(error_of([&] { dem::io::write_file(folder / "circle", "a"); }),
             Catch::Matchers::Contains("is a symbolic link that leads back to itself"));
  CHECK(std::filesystem::is_symlink(folder / "circle"));
}

TEST_CASE("a file that is written anew keeps its permissions") {
  using std::filesystem::perms;
  const TempFolder folder;
  dem::io::write_file(folder / "private.txt", "old");
  for (const perms mode : {perms::owner_read | perms::owner_write, perms::owner_all | perms::group_read}) {
    std::filesystem::permissions(folder / "private.txt", mode);
    dem::io::write_file(folder / "private.txt", "new");
    CHECK(std::filesystem::status(folder / "private.txt").permissions() == mode);
  }
}

TEST_CASE("what goes to an open descriptor stands between what was printed before and after") {
  const TempFolder folder;
  std::FILE* log = std::fopen((folder / "log").c_str(), "wb");
  const std::string name = "/dev/fd/" + std::to_string(::fileno(log));
  if (!std::filesystem::exists(name)) return;
  std::fputs("before ", log);
  dem::io::write_file(name, "written ");
  { dem::io::OutputFile(name).write("twice "); }
  std::fputs("after", log);
  std::fclose(log);
  CHECK(read_file(folder / "log") == "before written twice after");
}

TEST_CASE("what is no file is written as it is") {
  const TempFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  dem::io::write_file(folder / "pipe", "through");
  CHECK(std::filesystem::is_fifo(folder / "pipe"));
  char text[16] = {};
  CHECK(::read(reader, text, sizeof text) == 7);
  CHECK(std::string(text) == "through");
  ::close(reader);
  if (!std::filesystem::exists("/dev/full")) return;
  CHECK(error_of([] { dem::io::write_file("/dev/full", "a"); }) ==
        "cannot write to '/dev/full' (No space left on device); check that the disk is not full");
  CHECK(!std::filesystem::is_regular_file("/dev/full"));
}

TEST_CASE("a process that is killed while it writes leaves nothing, and the older file") {
  const TempFolder folder;
  const int probe = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0666);
  if (probe < 0) return;  // no such files here
  ::close(probe);
  dem::io::write_file(folder / "a.txt", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    dem::io::AtomicFile file(folder / "a.txt");
    file.write(std::string(100'000, 'x'));
    std::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK(read_file(folder / "a.txt") == "old");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
  // What a process of another system left is in nobody's way.
  dem::io::OutputFile(folder / "a.txt.tmp").close();
  dem::io::write_file(folder / "a.txt", "new");
  CHECK(read_file(folder / "a.txt") == "new");
  CHECK(!std::filesystem::exists(folder / "a.txt.tmp"));
}

TEST_CASE("two that write one file at once do not mix their bytes") {
  const TempFolder folder;
  dem::io::AtomicFile first(folder / "a.txt"), second(folder / "a.txt");
  first.write("first");
  second.write("second");
  first.commit();
  CHECK(read_file(folder / "a.txt") == "first");
  second.commit();
  CHECK(read_file(folder / "a.txt") == "second");
}

TEST_CASE("an atomic file appears complete or not at all") {
  const TempFolder folder;
  const auto path = folder / "a.txt";
  dem::io::write_file(path, "old");
  {
    dem::io::AtomicFile file(path);
    file.write("half");
    CHECK(read_file(path) == "old");
  }
  CHECK(read_file(path) == "old");
  CHECK(!std::filesystem::exists(folder / "a.txt.tmp"));
  dem::io::write_file(path, "new");
  CHECK(read_file(path) == "new");
}
