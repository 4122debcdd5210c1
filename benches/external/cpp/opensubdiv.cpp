// The column of OpenSubdiv: the topology of the base level, which stores six relations as flat tables.
#include "column.hpp"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/version.h>

namespace far = OpenSubdiv::Far;
using column::Vector;

struct Adapter {
    struct Vertex { int number; };
    struct Edge { int number; };
    struct Face { int number; };

    static std::string library() {
        const int version = OPENSUBDIV_VERSION_NUMBER;
        return "OpenSubdiv " + std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100);
    }

    std::unique_ptr<far::TopologyRefiner> refiner;
    std::vector<Vector> positions;

    explicit Adapter(const column::Input& input) : positions(input.positions) {
        std::vector<int> sizes(input.faces());
        for (int f = 0; f < input.faces(); ++f) sizes[f] = input.starts[f + 1] - input.starts[f];
        far::TopologyDescriptor mesh;
        mesh.numVertices = int(input.positions.size());
        mesh.numFaces = input.faces();
        mesh.numVertsPerFace = sizes.data();
        mesh.vertIndicesPerFace = input.corners.data();
        using Factory = far::TopologyRefinerFactory<far::TopologyDescriptor>;
        refiner.reset(Factory::Create(mesh, Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK)));
        if (!refiner) throw std::runtime_error("it refuses the topology");
    }

    far::TopologyLevel const& level() const { return refiner->GetLevel(0); }

    template <class F> void each_vertex(F f) const { for (int i = 0, n = level().GetNumVertices(); i < n; ++i) f(Vertex{i}); }
    template <class F> void each_edge(F f) const { for (int i = 0, n = level().GetNumEdges(); i < n; ++i) f(Edge{i}); }
    template <class F> void each_face(F f) const { for (int i = 0, n = level().GetNumFaces(); i < n; ++i) f(Face{i}); }
    template <class Handle> size_t index(Handle handle) const { return size_t(handle.number); }
    Face face(size_t number) const { return Face{int(number)}; }
    template <class F> void vertex_vertices(Vertex v, F f) const {
        for (int e : row(level().GetVertexEdges(v.number))) {
            const auto ends = level().GetEdgeVertices(e);
            f(Vertex{ends[0] == v.number ? ends[1] : ends[0]});
        }
    }
    template <class F> void vertex_edges(Vertex v, F f) const {
        for (int e : row(level().GetVertexEdges(v.number))) f(Edge{e});
    }
    template <class F> void vertex_faces(Vertex v, F f) const {
        for (int x : row(level().GetVertexFaces(v.number))) f(Face{x});
    }
    std::pair<Vertex, Vertex> edge_ends(Edge e) const {
        const auto ends = level().GetEdgeVertices(e.number);
        return {Vertex{ends[0]}, Vertex{ends[1]}};
    }
    template <class F> void edge_faces(Edge e, F f) const {
        for (int x : row(level().GetEdgeFaces(e.number))) f(Face{x});
    }
    template <class F> void face_vertices(Face x, F f) const {
        for (int v : row(level().GetFaceVertices(x.number))) f(Vertex{v});
    }
    template <class F> void face_edges(Face x, F f) const {
        for (int e : row(level().GetFaceEdges(x.number))) f(Edge{e});
    }
    template <class F> void face_faces(Face x, F f) const {
        for (int e : row(level().GetFaceEdges(x.number)))
            for (int y : row(level().GetEdgeFaces(e)))
                if (y != x.number) f(Face{y});
    }
    Vector position(Vertex v) const { return positions[v.number]; }
    void set_position(Vertex v, Vector p) { positions[v.number] = p; }

  private:
    // A row of a table as a range for `for` loops.
    struct Row {
        far::ConstIndexArray of;
        const int* begin() const { return of.begin(); }
        const int* end() const { return of.end(); }
    };
    static Row row(far::ConstIndexArray of) { return {of}; }
};

int main(int argc, char** argv) { return column::serve<Adapter>(argc, argv); }
