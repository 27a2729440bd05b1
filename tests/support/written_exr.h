// Small OpenEXR files for tests, written by OpenEXR itself.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cmath>
#include <string>
#include <vector>

namespace crescent {

/// One part; a channel's value at a pixel is smooth in x and y and differs between channels.
struct WrittenExr {
    std::vector<std::string> channels = {"R", "G", "B"};
    Imath::Box2i data{{0, 0}, {20, 12}}, display{{0, 0}, {20, 12}};
    Imf::PixelType type = Imf::FLOAT;
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    bool tiled = false;
    Imf::LevelMode levels = Imf::ONE_LEVEL;               // of tiles; only the full resolution is written
    std::vector<std::pair<std::string, float>> constant;  // channels of one value
    Imf::Header more;                                     // its attributes that the others lack are written too

    static float value(int channel, int x, int y) {
        return 0.6f +
            0.4f * std::sin(0.3f * static_cast<float>(x) + static_cast<float>(channel)) *
            std::cos(0.2f * static_cast<float>(y));
    }

    void write(const std::string& path) const {
        Imf::Header header(display, data);
        for (auto a = more.begin(); a != more.end(); ++a)
            if (!header.findTypedAttribute<Imf::Attribute>(a.name())) header.insert(a.name(), a.attribute());
        header.compression() = compression;
        const int w = data.max.x - data.min.x + 1, h = data.max.y - data.min.y + 1;
        std::vector<std::vector<float>> planes;
        std::vector<std::string> names = channels;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            planes.emplace_back();
            for (int y = data.min.y; y <= data.max.y; ++y)
                for (int x = data.min.x; x <= data.max.x; ++x)
                    planes.back().push_back(value(static_cast<int>(c), x, y));
        }
        for (const auto& [name, x] : constant) {
            names.push_back(name);
            planes.emplace_back(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), x);
        }
        std::vector<std::vector<half>> halves;
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < names.size(); ++c) {
            header.channels().insert(names[c], Imf::Channel(type));
            halves.emplace_back(planes[c].begin(), planes[c].end());
        }
        for (std::size_t c = 0; c < names.size(); ++c) {
            const std::size_t size = type == Imf::HALF ? 2 : 4;
            char* first = type == Imf::HALF ? reinterpret_cast<char*>(halves[c].data())
                                            : reinterpret_cast<char*>(planes[c].data());
            const std::ptrdiff_t corner = static_cast<std::ptrdiff_t>(size) * (data.min.y * w + data.min.x);
            buffer.insert(names[c], Imf::Slice(type, first - corner, size, size * static_cast<std::size_t>(w)));
        }
        if (tiled) {
            header.setTileDescription(Imf::TileDescription(8, 8, levels));
            Imf::TiledOutputFile file(path.c_str(), header);
            file.setFrameBuffer(buffer);
            file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1);
        } else {
            Imf::OutputFile file(path.c_str(), header);
            file.setFrameBuffer(buffer);
            file.writePixels(h);
        }
    }
};

}  // namespace crescent
