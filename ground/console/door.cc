#include "ground/console/door.h"

#include <fmt/format.h>
#include <qrencode.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "common/base/output_file.h"
#include "common/base/read_file.h"
#include "common/security/certificate.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr int kTokenBits = 100;

/// "operator CODE" and "viewer CODE", a line each.
std::optional<AccessTokens> ReadTokens(const fs::path& path) {
  constexpr std::uint64_t kMaxBytes = 4096;
  const Result<std::string> text = ReadFile(path, kMaxBytes);
  if (!text) return std::nullopt;
  const auto value = [&](const std::string& name) {
    const std::size_t at = text->find(name + " ");
    if (at == std::string::npos) return std::string();
    const std::size_t first = at + name.size() + 1;
    return text->substr(first, text->find('\n', first) - first);
  };
  AccessTokens tokens{value("viewer"), value("operator")};
  if (tokens.viewer.empty() || tokens.operator_token.empty()) return std::nullopt;
  return tokens;
}

Result<AccessTokens> PrepareTokens(const fs::path& folder) {
  const fs::path path = folder / "codes.txt";
  if (std::optional<AccessTokens> kept = ReadTokens(path)) return std::move(*kept);
  AccessTokens tokens{RandomToken(kTokenBits), RandomToken(kTokenBits)};
  std::error_code error;
  fs::create_directories(folder, error);
  fs::permissions(folder, fs::perms::owner_all, error);
  if (Status written = WriteFile(
          path, fmt::format("operator {}\nviewer {}\n", tokens.operator_token, tokens.viewer));
      !written.ok())
    return Err(std::move(written));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write, error);
  return tokens;
}

/// The address that others call: the first that is not this computer's own, if it listens on all.
std::string ShownHost(const std::string& address) {
  std::string host = address;
  if (address == "0.0.0.0" || address == "::") {
    for (const std::string& name : NamesOfThisComputer()) {
      const bool is_ipv4 =
          std::ranges::count(name, '.') == 3 &&
          std::ranges::all_of(name, [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
      if (is_ipv4 && !IsLoopbackAddress(name)) {
        host = name;
        break;
      }
    }
  }
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

struct FreeQr {
  void operator()(QRcode* code) const { QRcode_free(code); }
};

}  // namespace

bool IsLoopbackAddress(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

std::string Door::Address(int port) const {
  return fmt::format("{}://{}:{}", is_secure ? "https" : "http", ShownHost(server.address), port);
}

std::string Door::Address(int port, const std::string& token) const {
  return Address(port) + "/#code=" + token;
}

Result<Door> PrepareDoor(const GroundOptions& options) {
  const ConsoleOptions& console = options.console();
  Door door;
  door.server.address = console.address();
  door.server.port = console.port();
  const bool is_here_only = IsLoopbackAddress(console.address());
  door.is_secure = console.has_tls() ? console.tls() : !is_here_only;
  door.state_dir =
      console.state_dir().empty() ? options.live().output_dir() + "/.console" : console.state_dir();
  if (!is_here_only) {
    Result<AccessTokens> tokens = PrepareTokens(door.state_dir);
    if (!tokens) return Err(tokens.error());
    door.tokens = std::move(*tokens);
  }
  if (!door.is_secure) return door;
  door.server.certificate_file = console.certificate_file();
  door.server.key_file = console.key_file();
  if (door.server.certificate_file.empty()) {
    const auto files = PrepareCertificate(door.state_dir, NamesOfThisComputer());
    if (!files) return Err(files.error());
    door.server.certificate_file = files->certificate;
    door.server.key_file = files->key;
  }
  Result<std::string> fingerprint = CertificateFingerprint(door.server.certificate_file);
  if (!fingerprint) return Err(fingerprint.error());
  door.fingerprint = std::move(*fingerprint);
  return door;
}

std::string QrText(const std::string& text) {
  const std::unique_ptr<QRcode, FreeQr> code(
      QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L));
  if (!code) return "";
  constexpr int kQuiet = 2;  // Modules around it.
  const auto is_dark = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < code->width && y < code->width &&
           (code->data[y * code->width + x] & 1) != 0;
  };
  std::string lines;
  for (int y = -kQuiet; y < code->width + kQuiet; y += 2) {
    for (int x = -kQuiet; x < code->width + kQuiet; ++x) {
      const bool upper = !is_dark(x, y), lower = !is_dark(x, y + 1);  // Light is drawn.
      lines += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    lines += '\n';
  }
  return lines;
}

}  // namespace isotherm
