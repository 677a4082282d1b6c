// OpenEXR streams over bytes in memory, so that files are read and written in one checked step.
#pragma once

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfIO.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace stokes {

class MemoryWriter : public Imf::OStream {
  public:
    explicit MemoryWriter(const char* name) : OStream(name) {}
    void write(const char data[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        bytes.resize(std::max(bytes.size(), position_ + size));
        std::memcpy(bytes.data() + position_, data, size);
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::string bytes;

  private:
    std::size_t position_ = 0;
};

class MemoryReader : public Imf::IStream {
  public:
    MemoryReader(const char* name, const std::string& bytes) : IStream(name), bytes_(bytes) {}
    bool read(char data[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (count < 0 || position_ > bytes_.size() || size > bytes_.size() - position_)
            throw Iex::InputExc("unexpected end of file");
        std::memcpy(data, bytes_.data() + position_, size);
        position_ += size;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    const std::string& bytes_;
    std::size_t position_ = 0;
};

}  // namespace stokes
