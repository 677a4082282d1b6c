#include "host/subsurface/gzip.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "host/core/error.hpp"

namespace stokes {
namespace {

// 15 bits of window; 16 more ask zlib for a gzip header.
constexpr int kGzipWindow = 15 + 16;
constexpr std::size_t kPiece = std::size_t{1} << 18;

Bytef* input(std::string_view text) { return reinterpret_cast<Bytef*>(const_cast<char*>(text.data())); }

struct Inflater {
    z_stream stream{};
    Inflater() {
        if (inflateInit2(&stream, kGzipWindow) != Z_OK) throw RunError("zlib cannot be started");
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream); }
};

}  // namespace

std::string compress_gzip(std::string_view text) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindow, 9, Z_DEFAULT_STRATEGY) != Z_OK)
        throw RunError("zlib cannot be started");
    std::string result(deflateBound(&stream, text.size()), '\0');
    stream.next_in = input(text);
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    const int status = deflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    if (status != Z_STREAM_END) throw RunError("zlib cannot compress");
    return result;
}

std::string decompress_gzip(std::string_view content, const std::string& name, std::size_t limit) {
    Inflater inflater;
    z_stream& stream = inflater.stream;
    stream.next_in = input(content);
    stream.avail_in = static_cast<uInt>(content.size());
    std::string result;
    int status = Z_OK;
    while (status == Z_OK) {
        const std::size_t done = result.size();
        if (done >= limit) throw InputError(fmt::format("{}: expected at most {} bytes of text", name, limit));
        result.resize(std::min(done + kPiece, limit));
        stream.next_out = reinterpret_cast<Bytef*>(result.data() + done);
        stream.avail_out = static_cast<uInt>(result.size() - done);
        status = inflate(&stream, Z_NO_FLUSH);
        result.resize(stream.total_out);
    }
    if (status != Z_STREAM_END || stream.avail_in != 0)
        throw InputError(fmt::format("{}: not a whole gzip file", name));
    return result;
}

}  // namespace stokes
