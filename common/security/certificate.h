#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// The files of a certificate, PEM.
struct CertificateFiles {
  std::filesystem::path certificate, key;
};

/// Makes a self-signed certificate for these names and IP addresses in `folder`, unless one is
/// there that is valid for another month. The key can be read by its owner only.
Result<CertificateFiles> PrepareCertificate(const std::filesystem::path& folder,
                                            const std::vector<std::string>& names);

/// "AB:CD:...", SHA-256 of the certificate: what a person compares with what the browser shows.
Result<std::string> CertificateFingerprint(const std::filesystem::path& certificate);

/// The names of this computer, and its addresses as text.
std::vector<std::string> NamesOfThisComputer();

}  // namespace isotherm
