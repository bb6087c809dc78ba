#include "common/security/certificate.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "common/base/host_name.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

struct Free {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(X509_EXTENSION* extension) const { X509_EXTENSION_free(extension); }
  void operator()(std::FILE* file) const { std::fclose(file); }
};
template <typename T>
using Owned = std::unique_ptr<T, Free>;

constexpr long kValid_s = 825L * 24 * 3600;  // The longest that browsers of phones take.
constexpr int kRenewBefore_s = 30 * 24 * 3600;

Owned<X509> Read(const fs::path& path) {
  const Owned<std::FILE> file(std::fopen(path.c_str(), "rb"));
  return Owned<X509>(file ? PEM_read_X509(file.get(), nullptr, nullptr, nullptr) : nullptr);
}

bool IsStillGood(const CertificateFiles& files) {
  const Owned<X509> certificate = Read(files.certificate);
  if (!certificate || access(files.key.c_str(), R_OK) != 0) return false;
  time_t later = time(nullptr) + kRenewBefore_s;
  return X509_cmp_time(X509_get0_notAfter(certificate.get()), &later) > 0;
}

bool IsAddress(const std::string& name) {
  in6_addr ignored{};
  return inet_pton(AF_INET, name.c_str(), &ignored) == 1 ||
         inet_pton(AF_INET6, name.c_str(), &ignored) == 1;
}

bool AddExtension(X509* certificate, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const Owned<X509_EXTENSION> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  return extension && X509_add_ext(certificate, extension.get(), -1) == 1;
}

std::string AlternativeNames(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", IsAddress(name) ? "IP" : "DNS", name);
  return text;
}

Owned<X509> MakeCertificate(EVP_PKEY* key, const std::vector<std::string>& names) {
  Owned<X509> certificate(X509_new());
  X509* const x = certificate.get();
  unsigned char serial[16];
  if (x == nullptr || RAND_bytes(serial, sizeof(serial)) != 1) return nullptr;
  serial[0] &= 0x7F;  // Positive.
  BIGNUM* number = BN_bin2bn(serial, sizeof(serial), nullptr);
  BN_to_ASN1_INTEGER(number, X509_get_serialNumber(x));
  BN_free(number);
  X509_set_version(x, 2);  // 3, counted from 0.
  X509_gmtime_adj(X509_getm_notBefore(x), -3600);
  X509_gmtime_adj(X509_getm_notAfter(x), kValid_s);
  X509_set_pubkey(x, key);
  X509_NAME* const name = X509_get_subject_name(x);
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>("Isotherm console"), -1, -1, 0);
  X509_set_issuer_name(x, name);
  const bool is_complete = AddExtension(x, NID_subject_alt_name, AlternativeNames(names)) &&
                           AddExtension(x, NID_basic_constraints, "critical,CA:FALSE") &&
                           AddExtension(x, NID_key_usage, "critical,digitalSignature") &&
                           AddExtension(x, NID_ext_key_usage, "serverAuth");
  if (!is_complete || X509_sign(x, key, EVP_sha256()) == 0) return nullptr;
  return certificate;
}

Status Write(const CertificateFiles& files, X509* certificate, EVP_PKEY* key) {
  const mode_t before = umask(0077);
  const Owned<std::FILE> key_file(std::fopen(files.key.c_str(), "wb"));
  umask(before);
  const Owned<std::FILE> certificate_file(std::fopen(files.certificate.c_str(), "wb"));
  if (!key_file || !certificate_file ||
      PEM_write_PrivateKey(key_file.get(), key, nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
      PEM_write_X509(certificate_file.get(), certificate) != 1)
    return IoError(files.certificate.parent_path().string() +
                   ": the console's certificate cannot be written");
  return OkStatus();
}

}  // namespace

Result<CertificateFiles> PrepareCertificate(const fs::path& folder,
                                            const std::vector<std::string>& names) {
  CertificateFiles files{folder / "certificate.pem", folder / "key.pem"};
  if (IsStillGood(files)) return files;
  std::error_code error;
  fs::create_directories(folder, error);
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"));
  if (!key) return Err(Internal("no key can be made for the console's certificate"));
  const Owned<X509> certificate = MakeCertificate(key.get(), names);
  if (!certificate) return Err(Internal("no certificate can be made for the console"));
  if (Status written = Write(files, certificate.get(), key.get()); !written.ok())
    return Err(std::move(written));
  return files;
}

Result<std::string> CertificateFingerprint(const fs::path& path) {
  const Owned<X509> certificate = Read(path);
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (!certificate || X509_digest(certificate.get(), EVP_sha256(), digest, &length) != 1)
    return Err(DataLoss(path.string() + ": not a certificate"));
  std::string text;
  for (unsigned int i = 0; i < length; ++i)
    text += fmt::format("{}{:02X}", i == 0 ? "" : ":", static_cast<unsigned>(digest[i]));
  return text;
}

std::vector<std::string> NamesOfThisComputer() {
  std::vector<std::string> names = {"localhost"};
  if (const std::string host = HostName(); !host.empty()) {
    names.push_back(host);
    names.push_back(host + ".local");
  }
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return names;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr) continue;
    const int family = entry->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    char text[NI_MAXHOST] = {};
    const socklen_t length = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    if (getnameinfo(entry->ifa_addr, length, text, sizeof(text), nullptr, 0, NI_NUMERICHOST) != 0)
      continue;
    // Addresses of one link carry its name behind a percent sign.
    if (std::string(text).find('%') == std::string::npos) names.emplace_back(text);
  }
  freeifaddrs(list);
  return names;
}

}  // namespace isotherm
