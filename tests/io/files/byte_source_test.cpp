#include "thermfit/io/files/byte_source.hpp"

#include <sys/stat.h>

#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

std::string message(const std::string& path, const ScratchFolder& folder) {
  try {
    read_campaign({path});
  } catch (const Error& error) {
    return folder.without_folder(error.what());
  }
  return "read";
}

#ifdef THERMFIT_HAS_ZLIB
std::string compressed(const std::string& text) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string result(text.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  result.resize(result.size() - stream.avail_out);
  deflateEnd(&stream);
  return result;
}
#endif

}  // namespace

TEST_CASE("files that cannot be opened or read give the system's reason", "[io]") {
  const ScratchFolder folder;
  CHECK(message(folder.path("no.csv"), folder) ==
        "no.csv: No such file or directory; allowed: a file that can be read");
  ::mkdir(folder.path("d.csv").c_str(), 0700);
  CHECK(message(folder.path("d.csv"), folder) == "d.csv: Is a directory; allowed: a file that can be read");
}

#ifdef THERMFIT_HAS_ZLIB
TEST_CASE("gzip is known by its content, joined members and a byte order mark inside are read", "[io]") {
  const ScratchFolder folder;
  const std::string head = "\xEF\xBB\xBFtime_s;T1\r\n0;20,5\r\n", tail = "1;21,5\r\n";
  const CsvReading plain = read_campaign({folder.write("a.csv", head + tail)});
  for (const char* name : {"b.csv.gz", "b.csv"}) {
    const CsvReading reading = read_campaign({folder.write(name, compressed(head) + compressed(tail))});
    CHECK(reading.batches[0].digest == plain.batches[0].digest);
    CHECK(reading.batches[0].name == "b");
    CHECK(reading.files[0].dialect.compressed);
  }
}

TEST_CASE("gzip data that are cut anywhere or changed are refused, never read in part", "[io]") {
  const ScratchFolder folder;
  std::string text = "time_s,T1\n";
  for (int row = 0; row < 2000; ++row) text += std::to_string(row) + ",20." + std::to_string(row * 7919 % 1000) + '\n';
  const std::string whole = compressed(text);
  for (std::size_t size = 2; size < whole.size(); size += 97)
    CHECK(message(folder.write("a.csv", whole.substr(0, size)), folder) ==
          "a.csv: the compressed data end in the middle; allowed: a whole gzip file; copy the file again");
  std::string broken = whole;
  broken[whole.size() - 6] = static_cast<char>(broken[whole.size() - 6] ^ 1);
  CHECK(message(folder.write("a.csv", broken), folder) ==
        "a.csv: broken gzip data: incorrect data check; allowed: a whole gzip file; copy the file again");
}
#else
TEST_CASE("without zlib a gzip file is an error that says what to type", "[io]") {
  const ScratchFolder folder;
  CHECK(message(folder.write("a.csv", "\x1f\x8b rest"), folder).find("zcat") != std::string::npos);
}
#endif
