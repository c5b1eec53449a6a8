#include "core/read/column_file.hpp"

#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <random>

namespace driftlab {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::read_file;
using testing::TemporaryDirectory;
using testing::write_file;

std::vector<double> noise(std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<double> values(count);
  for (double& value : values) {
    value = std::bit_cast<double>((random() >> 2U) | 1U);  // any positive finite pattern below 2
  }
  return values;
}

/// A small table on disk.
std::filesystem::path write_table(const TemporaryDirectory& directory, const ColumnNames& names, std::size_t rows) {
  auto path = directory / "table";
  auto writer = ColumnFileWriter::create(path, names);
  EXPECT_TRUE(writer);
  EXPECT_TRUE(writer->append_rows(noise(rows * names.size())));
  EXPECT_EQ(writer->finish(), rows);
  return path;
}

TEST(ColumnFile, GivesBackWhatWasWrittenInRows) {
  // 300000 rows make every column spill its 65536-value buffer several times.
  for (const std::size_t rows : {1U, 7U, 8U, 65536U, 65537U, 300000U}) {
    const TemporaryDirectory directory;
    const std::vector<double> values = noise(rows * 3);
    auto writer = ColumnFileWriter::create(directory / "table", {"t", "gx (°/s)", ""});
    ASSERT_TRUE(writer);
    std::mt19937_64 random(8);
    for (std::size_t row = 0; row < rows;) {
      const std::size_t batch = std::min<std::size_t>(rows - row, 1 + random() % 5000);
      ASSERT_TRUE(writer->append_rows(std::span(values).subspan(row * 3, batch * 3)));
      row += batch;
    }
    ASSERT_EQ(writer->finish(), rows);
    EXPECT_THAT(directory.entries(), ElementsAre("table"));
    const auto file = ColumnFile::open(directory / "table");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->rows(), rows);
    EXPECT_THAT(file->names(), ElementsAre("t", "gx (°/s)", ""));
    for (std::size_t column = 0; column < 3; ++column) {
      const auto span = file->column(column);
      ASSERT_EQ(span.size(), rows);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(span.data()) % 64, 0U);
      for (std::size_t row = 0; row < rows; ++row) {
        ASSERT_EQ(span[row], values[row * 3 + column]);
      }
    }
  }
}

TEST(ColumnFile, GivesBackWhatWasWrittenColumnByColumn) {
  const TemporaryDirectory directory;
  const std::vector<double> values = noise(200000);
  auto writer = ColumnFileWriter::create(directory / "table", {"a", "b"});
  ASSERT_TRUE(writer->append_column(1, values));
  ASSERT_TRUE(writer->append_column(0, std::span(values).first(1)));
  ASSERT_TRUE(writer->append_column(0, std::span(values).subspan(1)));
  ASSERT_EQ(writer->finish(), values.size());
  const auto file = ColumnFile::open(directory / "table");
  for (std::size_t column = 0; column < 2; ++column) {
    EXPECT_TRUE(std::equal(values.begin(), values.end(), file->column(column).begin()));
  }
}

TEST(ColumnFile, HoldsThousandColumnsInBoundedBuffers) {
  const TemporaryDirectory directory;
  ColumnNames names;
  for (int i = 0; i < 1024; ++i) {
    names.push_back(std::to_string(i));
  }
  const auto file = ColumnFile::open(write_table(directory, names, 5000));
  ASSERT_TRUE(file);
  const std::vector<double> values = noise(std::size_t{5000} * 1024);
  EXPECT_EQ(file->column(1023)[4999], values.back());
  EXPECT_EQ(file->column(512)[2100], values[2100 * 1024 + 512]);
}

TEST(ColumnFile, LeavesNothingWithoutFinish) {
  const TemporaryDirectory directory;
  {
    auto writer = ColumnFileWriter::create(directory / "table", {"a"});
    ASSERT_TRUE(writer->append_rows(noise(500000)));
    EXPECT_THAT(directory.entries(), IsEmpty());  // not even while it works
  }
  EXPECT_THAT(directory.entries(), IsEmpty());
}

TEST(ColumnFile, RefusesColumnsOfUnequalLength) {
  const TemporaryDirectory directory;
  auto writer = ColumnFileWriter::create(directory / "table", {"a", "b"});
  ASSERT_TRUE(writer->append_column(0, noise(3)));
  const auto rows = writer->finish();
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().code, ErrorCode::ShapeMismatch);
  EXPECT_THAT(directory.entries(), IsEmpty());
}

TEST(ColumnFile, RefusesNoColumnsAndNamesakes) {
  const TemporaryDirectory directory;
  EXPECT_EQ(ColumnFileWriter::create(directory / "table", {}).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(ColumnFileWriter::create(directory / "table", {"a", "a"}).error().code, ErrorCode::DuplicateColumn);
}

TEST(ColumnFile, ReplacesWhatWasThereOnlyWhenFinished) {
  const TemporaryDirectory directory;
  write_file(directory / "table", "old");
  auto writer = ColumnFileWriter::create(directory / "table", {"a"});
  ASSERT_TRUE(writer->append_rows(noise(2)));
  EXPECT_EQ(read_file(directory / "table"), "old");
  ASSERT_TRUE(writer->finish());
  EXPECT_TRUE(ColumnFile::open(directory / "table"));
}

TEST(ColumnFile, FollowsItsDocumentedBytes) {
  const TemporaryDirectory directory;
  auto writer = ColumnFileWriter::create(directory / "table", {"t", "gx"});
  ASSERT_TRUE(writer->append_rows(std::vector<double>{1.0, 2.0, 3.0, 4.0}));
  ASSERT_TRUE(writer->finish());
  const std::string bytes = read_file(directory / "table");
  const auto word = [&bytes](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x89"
                                            "DLCOL\r\n"));
  EXPECT_EQ(word(8), (std::uint64_t{2} << 32) | 1U);  // version 1, two columns
  EXPECT_EQ(word(16), 2U);                            // rows
  EXPECT_EQ(word(24), 64U);                           // stride: 16 bytes rounded up
  EXPECT_EQ(word(32), 128U);                          // 64 + names of 11 bytes, rounded up
  EXPECT_EQ(word(40), 11U);
  EXPECT_EQ(word(48), 256U);
  EXPECT_EQ(bytes.size(), 256U);
  EXPECT_EQ(bytes.substr(64, 11), std::string("\x01\0\0\0t\x02\0\0\0gx", 11));
  EXPECT_EQ(std::bit_cast<double>(word(128 + 8)), 3.0);
  EXPECT_EQ(std::bit_cast<double>(word(192)), 2.0);
}

TEST(ColumnFile, RefusesEveryTruncation) {
  const TemporaryDirectory directory;
  const std::string bytes = read_file(write_table(directory, {"t", "gx", "gy"}, 20));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_file(directory / "cut", std::string_view(bytes).substr(0, length));
    const auto file = ColumnFile::open(directory / "cut");
    ASSERT_FALSE(file) << length;
    EXPECT_EQ(file.error().code, ErrorCode::Truncated) << length;
    EXPECT_EQ(file.error().fields.front().value, "cut");
  }
  write_file(directory / "long", bytes + "x");
  EXPECT_EQ(ColumnFile::open(directory / "long").error().code, ErrorCode::ShapeMismatch);
}

TEST(ColumnFile, RefusesEveryChangedBitOfItsHeaderAndNames) {
  const TemporaryDirectory directory;
  const std::string bytes = read_file(write_table(directory, {"t", "gx", "gy"}, 20));
  const std::size_t guarded = 64 + 3 * 4 + 5;
  for (std::size_t bit = 0; bit < 8 * guarded; ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(static_cast<unsigned char>(damaged[bit / 8]) ^ (1U << (bit % 8)));
    write_file(directory / "damaged", damaged);
    EXPECT_FALSE(ColumnFile::open(directory / "damaged")) << "bit " << bit;
  }
}

TEST(ColumnFile, NamesTheFileButNotItsPlace) {
  const TemporaryDirectory directory;
  const auto missing = ColumnFile::open(directory / "missing");
  EXPECT_EQ(missing.error().code, ErrorCode::NotFound);
  EXPECT_EQ(missing.error().fields.front().value, "missing");
  EXPECT_THAT(missing.error().message, ::testing::Not(HasSubstr("/")));
  EXPECT_EQ(ColumnFile::open(directory / ".").error().code, ErrorCode::Io);
  auto nowhere = ColumnFileWriter::create(directory / "none/table", {"a"});
  ASSERT_TRUE(nowhere->append_rows(noise(1)));
  EXPECT_EQ(nowhere->finish().error().code, ErrorCode::Io);
}

TEST(ColumnFile, MovesItsMapping) {
  const TemporaryDirectory directory;
  auto file = ColumnFile::open(write_table(directory, {"a"}, 3));
  ColumnFile moved = std::move(*file);
  const double last = moved.column(0)[2];
  auto other = ColumnFile::open(directory / "table");
  *other = std::move(moved);
  EXPECT_EQ(other->column(0)[2], last);
}

/// Limits the size of every file this process writes; the kernel then refuses as it does on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    previous_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &previous_);
    const rlimit limit{bytes, previous_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previous_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit previous_{};
  void (*previous_handler_)(int) = nullptr;
};

TEST(ColumnFile, ReportsAFullDiskAndLeavesNothing) {
  const TemporaryDirectory directory;
  const std::vector<double> values = noise(1'000'000);
  {
    const FileSizeLimit limit(3'000'000);  // the spool does not fit
    auto writer = ColumnFileWriter::create(directory / "table", {"a"});
    const Status status = writer->append_rows(values);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::DiskFull);
  }
  EXPECT_THAT(directory.entries(), IsEmpty());
  auto writer = ColumnFileWriter::create(directory / "table", {"a"});
  ASSERT_TRUE(writer->append_rows(values));
  {
    const FileSizeLimit limit(3'000'000);  // the table does not fit
    const auto rows = writer->finish();
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.error().code, ErrorCode::DiskFull);
    EXPECT_EQ(rows.error().fields.front().value, "table");
  }
  EXPECT_THAT(directory.entries(), IsEmpty());
}

}  // namespace
}  // namespace driftlab
