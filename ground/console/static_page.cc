#include "ground/console/static_page.h"

#include <zlib.h>

#include <algorithm>

#include "ground/console/text_reply.h"

namespace isotherm {
namespace {

/// For clients that do not unpack themselves. What we packed ourselves is whole.
std::string Unpack(std::string_view gzip) {
  constexpr int kGzipWindow = 15 + 16;
  std::string bytes;
  z_stream stream{};
  if (inflateInit2(&stream, kGzipWindow) != Z_OK) return bytes;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.avail_in = static_cast<uInt>(gzip.size());
  int state = Z_OK;
  while (state == Z_OK) {
    constexpr std::size_t kChunk = 64U << 10;
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + before);
    stream.avail_out = kChunk;
    state = inflate(&stream, Z_NO_FLUSH);
    bytes.resize(before + kChunk - stream.avail_out);
  }
  inflateEnd(&stream);
  return bytes;
}

}  // namespace

void AddSafetyHeaders(WebReply& reply) {
  reply.headers.insert(
      reply.headers.end(),
      {{"Content-Security-Policy",
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src "
        "'self'; img-src 'self' blob: data:; connect-src 'self'; manifest-src 'self'; base-uri "
        "'none'; form-action 'self'; frame-ancestors 'none'"},
       {"X-Content-Type-Options", "nosniff"},
       {"Referrer-Policy", "no-referrer"},
       {"Cross-Origin-Opener-Policy", "same-origin"},
       {"Cross-Origin-Resource-Policy", "same-origin"},
       {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"}});
}

WebReply StaticPage::Answer(const WebRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD")
    return TextReply(405, "only GET is answered here\n");
  const std::string_view asked = request.path;
  const std::string_view path = asked == "/" ? "/index.html" : asked;
  const auto files = PageFiles();
  if (files.empty())
    return TextReply(404, "this program was built without the console's page; the data is there\n");
  const auto found = std::ranges::find(files, path, &PageFile::path);
  if (found == files.end()) return TextReply(404, "there is no such file\n");
  WebReply reply;
  reply.content_type = found->content_type;
  reply.headers = {{"ETag", std::string(found->etag)}, {"Cache-Control", "no-cache"}};
  if (request.if_none_match == found->etag) {
    reply.status = 304;
    return reply;
  }
  if (request.accepts_gzip) reply.headers.emplace_back("Content-Encoding", "gzip");
  reply.headers.emplace_back("Vary", "Accept-Encoding");
  reply.body = std::make_shared<const std::string>(request.accepts_gzip ? std::string(found->gzip)
                                                                        : Unpack(found->gzip));
  return reply;
}

}  // namespace isotherm
