// Walks from the build items down to the meshes, with the product of the transforms on the way.
#include "host_tools/job/import/threemf_facets.hpp"

#include <iterator>
#include <memory>
#include <utility>

#include "firmware/base/inch.hpp"
#include "host_tools/base/files/file_set.hpp"
#include "host_tools/base/files/files.hpp"

#include "Model/COM/NMR_DLLInterfaces.h"

namespace cusp::import {
namespace {

using Handle = NMR::PLib3MFBase*;

struct Release {
    void operator()(Handle object) const { NMR::lib3mf_release(object); }
};
using Owned = std::unique_ptr<NMR::PLib3MFBase, Release>;

struct Unit {
    const char* name;
    double millimetres;
};
constexpr Unit kUnits[]{{"micron", 1e-3},   {"millimeter", 1},
                        {"centimeter", 10}, {"inch", kMillimetresPerInch},
                        {"foot", 304.8},    {"meter", 1000}};

// Row vectors: a point is (x y z 1) times the four rows.
struct Placed {
    Vec3d rows[4]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};

    Vec3d turned(Vec3d p) const { return p.x * rows[0] + p.y * rows[1] + p.z * rows[2]; }
    Vec3d of(Vec3d p) const { return turned(p) + rows[3]; }
    bool is_mirrored() const { return dot(cross(rows[0], rows[1]), rows[2]) < 0; }
    // This one first, then `outer`.
    Placed within(const Placed& outer) const
    {
        return {{outer.turned(rows[0]), outer.turned(rows[1]), outer.turned(rows[2]),
                 outer.of(rows[3])}};
    }
};

Placed placed_of(const NMR::MODELTRANSFORM& transform)
{
    Placed placed;
    for (unsigned row = 0; row < 4; ++row) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            placed.rows[row][axis] = static_cast<double>(transform.m_fFields[axis][row]);
        }
    }
    return placed;
}

class ThreemfReader {
public:
    explicit ThreemfReader(const std::string& file) : file_{file} {}

    Facets read();

private:
    // Components may nest; a file that nests deeper than this is refused.
    static constexpr int kDeepest = 32;
    static constexpr int kMostObjects = 100000;  // after components are multiplied out

    // Throws lib3mf's message on the failed call.
    void check(int result, Handle about) const;
    // The result of `make`; on failure, throws lib3mf's reason for `about`.
    template <class Make>
    Owned made(const Make& make, Handle about) const
    {
        Handle object = nullptr;
        check(make(&object), about);
        return Owned{object};
    }
    void read_items(Handle model);
    void add_object(Handle object, const Placed& placed, int depth);
    void add_components(Handle object, const Placed& placed, int depth);
    void add_mesh(Handle mesh, const Placed& placed);

    std::string file_;
    double unit_{1.0};  // mm
    int objects_{0};
    Facets facets_;
};

void ThreemfReader::check(int result, Handle about) const
{
    if (result == 0) {
        return;
    }
    DWORD code = 0;
    const char* message = nullptr;
    if (about != nullptr) {
        NMR::lib3mf_getlasterror(about, &code, &message);
    }
    throw InputError(fmt::format("{}: this is no 3MF file that can be read: {}", file_,
                                 message != nullptr ? message : "lib3mf gives no reason"));
}

Facets ThreemfReader::read()
{
    files::text_of_file(file_);  // says why a file can't be read
    const Owned model = made([&](Handle* out) { return NMR::lib3mf_createmodel(out); }, nullptr);
    const Owned reader =
        made([&](Handle* out) { return NMR::lib3mf_model_queryreader(model.get(), "3mf", out); },
             model.get());
    check(NMR::lib3mf_reader_readfromfileutf8(reader.get(), file_.c_str()), reader.get());
    DWORD unit = 0;
    check(NMR::lib3mf_model_getunit(model.get(), &unit), model.get());
    if (unit >= std::size(kUnits)) {
        throw InputError(fmt::format("{}: its unit is number {}, known are 0 to {}", file_, unit,
                                     std::size(kUnits) - 1));
    }
    unit_ = kUnits[unit].millimetres;
    facets_.unit = kUnits[unit].name;
    read_items(model.get());
    return std::move(facets_);
}

void ThreemfReader::read_items(Handle model)
{
    const Owned items =
        made([&](Handle* out) { return NMR::lib3mf_model_getbuilditems(model, out); }, model);
    BOOL more = 0;
    for (check(NMR::lib3mf_builditemiterator_movenext(items.get(), &more), items.get()); more != 0;
         check(NMR::lib3mf_builditemiterator_movenext(items.get(), &more), items.get())) {
        const Owned item = made(
            [&](Handle* out) { return NMR::lib3mf_builditemiterator_getcurrent(items.get(), out); },
            items.get());
        const Owned object = made(
            [&](Handle* out) { return NMR::lib3mf_builditem_getobjectresource(item.get(), out); },
            item.get());
        NMR::MODELTRANSFORM transform{};
        check(NMR::lib3mf_builditem_getobjecttransform(item.get(), &transform), item.get());
        add_object(object.get(), placed_of(transform), 0);
    }
}

void ThreemfReader::add_object(Handle object, const Placed& placed, int depth)
{
    if (depth > kDeepest) {
        throw InputError(fmt::format("{}: components nest deeper than {} levels", file_, kDeepest));
    }
    if (++objects_ > kMostObjects) {
        throw InputError(fmt::format("{}: builds more than {} objects", file_, kMostObjects));
    }
    BOOL is_mesh = 0;
    check(NMR::lib3mf_object_ismeshobject(object, &is_mesh), object);
    if (is_mesh != 0) {
        add_mesh(object, placed);
    } else {
        add_components(object, placed, depth);
    }
}

void ThreemfReader::add_components(Handle object, const Placed& placed, int depth)
{
    DWORD count = 0;
    check(NMR::lib3mf_componentsobject_getcomponentcount(object, &count), object);
    for (DWORD i = 0; i < count; ++i) {
        const Owned component = made(
            [&](Handle* out) { return NMR::lib3mf_componentsobject_getcomponent(object, i, out); },
            object);
        const Owned part = made(
            [&](Handle* out) {
                return NMR::lib3mf_component_getobjectresource(component.get(), out);
            },
            component.get());
        NMR::MODELTRANSFORM transform{};
        check(NMR::lib3mf_component_gettransform(component.get(), &transform), component.get());
        add_object(part.get(), placed_of(transform).within(placed), depth + 1);
    }
}

void ThreemfReader::add_mesh(Handle mesh, const Placed& placed)
{
    DWORD corners = 0;
    DWORD count = 0;
    check(NMR::lib3mf_meshobject_getvertexcount(mesh, &corners), mesh);
    check(NMR::lib3mf_meshobject_gettrianglecount(mesh, &count), mesh);
    std::vector<NMR::MODELMESHVERTEX> vertices(corners);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(count);
    check(NMR::lib3mf_meshobject_getvertices(mesh, vertices.data(), corners, nullptr), mesh);
    check(NMR::lib3mf_meshobject_gettriangleindices(mesh, triangles.data(), count, nullptr), mesh);
    for (const NMR::MODELMESHTRIANGLE& triangle : triangles) {
        std::array<Vec3d, 3> at;
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle.m_nIndices[i] >= corners) {
                throw InputError(fmt::format("{}: a triangle has the vertex {}, there are {}",
                                             file_, triangle.m_nIndices[i], corners));
            }
            const NMR::MODELMESHVERTEX& vertex = vertices[triangle.m_nIndices[i]];
            at[i] = unit_ * placed.of({static_cast<double>(vertex.m_fPosition[0]),
                                       static_cast<double>(vertex.m_fPosition[1]),
                                       static_cast<double>(vertex.m_fPosition[2])});
            check_corner(at[i], [&] { return file_; });
        }
        if (placed.is_mirrored()) {
            std::swap(at[1], at[2]);
        }
        add_facet(at, facets_);
    }
}

}  // namespace

Facets read_threemf(const std::string& file)
{
    Facets facets;
    files::with_file_on_disk(file,
                             [&](const std::string& path) { facets = ThreemfReader{path}.read(); });
    return facets;
}

}  // namespace cusp::import
