#include "common/security/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <fstream>
#include <memory>
#include <vector>

#include "common/base/check.h"

namespace isotherm {
namespace {

struct FreeDigest {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new()) {
    CHECK(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void Add(const char* bytes, std::size_t count) {
    CHECK(EVP_DigestUpdate(context_.get(), bytes, count) == 1);
  }
  std::string Hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int length = 0;
    CHECK(EVP_DigestFinal_ex(context_.get(), digest, &length) == 1);
    std::string text;
    for (unsigned int i = 0; i < length; ++i)
      text += fmt::format("{:02x}", static_cast<unsigned>(digest[i]));
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, FreeDigest> context_;
};

}  // namespace

std::string Sha256Of(std::string_view bytes) {
  Digest digest;
  digest.Add(bytes.data(), bytes.size());
  return digest.Hex();
}

Result<std::string> Sha256OfFile(const std::filesystem::path& path) {
  constexpr std::size_t kPiece = 1U << 20;
  std::ifstream file(path, std::ios::binary);
  if (!file) return Err(NotFound(path.string() + ": cannot be read"));
  Digest digest;
  std::vector<char> piece(kPiece);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0)
    digest.Add(piece.data(), static_cast<std::size_t>(file.gcount()));
  if (file.bad()) return Err(IoError(path.string() + ": reading failed"));
  return digest.Hex();
}

}  // namespace isotherm
