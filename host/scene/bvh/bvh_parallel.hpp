// How the BVH builder shares work between threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <future>
#include <utility>
#include <vector>

namespace stokes {

// Calls run(i) once for every i below count, in no certain order. Throws what a call throws.
template <class Run>
void run_parallel(unsigned threads, std::size_t count, const Run& run) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) run(i);
    };
    std::vector<std::future<void>> others;
    for (std::size_t i = 1; i < threads && i < count; ++i) others.push_back(std::async(std::launch::async, work));
    work();
    for (std::future<void>& other : others) other.get();
}

using BvhChunk = std::pair<std::uint32_t, std::uint32_t>;  // begin, end

// Cuts a range into pieces for so many threads: one piece where more would not pay.
inline std::vector<BvhChunk> make_chunks(unsigned threads, std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t least = 4096;
    const std::uint32_t size = end - begin;
    const std::uint32_t count = threads <= 1 ? 1 : std::clamp(size / least, 1u, 4 * threads);
    std::vector<BvhChunk> chunks;
    const auto edge = [&](std::uint64_t i) { return begin + static_cast<std::uint32_t>(size * i / count); };
    for (std::uint32_t i = 0; i < count; ++i) chunks.push_back({edge(i), edge(i + 1)});
    return chunks;
}

// Part run(begin, end) of every piece, in the order of the range.
template <class Part, class Run>
std::vector<Part> run_chunks(unsigned threads, const std::vector<BvhChunk>& chunks, const Run& run) {
    std::vector<Part> parts(chunks.size());
    run_parallel(threads, chunks.size(), [&](std::size_t i) { parts[i] = run(chunks[i].first, chunks[i].second); });
    return parts;
}

}  // namespace stokes
