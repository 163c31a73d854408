#include "thermfit/io/files/sha256.hpp"

#include <random>
#include <vector>

#include "support/catch.hpp"

using thermfit::sha256_hex;

TEST_CASE("SHA-256 gives the digests published in FIPS 180-4", "[io]") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256_hex(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("feeding SHA-256 in pieces of any size changes nothing", "[io]") {
  const std::string text(1000, 'x');
  for (const std::size_t piece : {1U, 55U, 56U, 63U, 64U, 65U, 999U}) {
    thermfit::Sha256 hash;
    for (std::size_t i = 0; i < text.size(); i += piece) hash.update(std::string_view(text).substr(i, piece));
    CHECK(hash.hex() == sha256_hex(text));
  }
}

TEST_CASE("the processor's SHA instructions and the portable code compress alike", "[io]") {
  using namespace thermfit::detail;
  std::mt19937 random(7);
  std::vector<unsigned char> bytes(64 * 20);
  for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
  for (const std::size_t blocks : {1U, 2U, 20U}) {
    Sha256State chosen{1, 2, 3, 4, 5, 6, 7, 0xffffffff}, portable = chosen;
    sha256_blocks(chosen, bytes.data(), blocks);
    sha256_blocks_portable(portable, bytes.data(), blocks);
    CHECK(chosen == portable);
  }
}
