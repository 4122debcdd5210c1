// The column of OpenMesh: PolyMesh_ArrayKernelT without status attributes, which queries do not need.
#include "column.hpp"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/config.h>

using column::Vector;

struct Adapter {
    using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;
    using Vertex = OpenMesh::VertexHandle;
    using Edge = OpenMesh::EdgeHandle;
    using Face = OpenMesh::FaceHandle;

    static std::string library() {
        return "OpenMesh " + std::to_string(OM_GET_VER) + "." + std::to_string(OM_GET_MAJ);
    }

    Mesh mesh;

    explicit Adapter(const column::Input& input) {
        mesh.reserve(input.positions.size(), input.corners.size() / 2, input.faces());
        for (const Vector& p : input.positions) mesh.add_vertex({p.x, p.y, p.z});
        std::vector<Vertex> corners;
        for (int f = 0; f < input.faces(); ++f) {
            corners.clear();
            for (int c = input.starts[f]; c < input.starts[f + 1]; ++c) corners.emplace_back(input.corners[c]);
            if (!mesh.add_face(corners).is_valid()) throw std::runtime_error("it refuses face " + std::to_string(f));
        }
    }

    template <class F> void each_vertex(F f) const { for (auto v : mesh.vertices()) f(Vertex(v)); }
    template <class F> void each_edge(F f) const { for (auto e : mesh.edges()) f(Edge(e)); }
    template <class F> void each_face(F f) const { for (auto x : mesh.faces()) f(Face(x)); }
    template <class Handle> size_t index(Handle handle) const { return size_t(handle.idx()); }
    Face face(size_t number) const { return Face(int(number)); }
    template <class F> void vertex_vertices(Vertex v, F f) const { for (auto w : mesh.vv_range(v)) f(Vertex(w)); }
    template <class F> void vertex_edges(Vertex v, F f) const { for (auto e : mesh.ve_range(v)) f(Edge(e)); }
    template <class F> void vertex_faces(Vertex v, F f) const { for (auto x : mesh.vf_range(v)) f(Face(x)); }
    std::pair<Vertex, Vertex> edge_ends(Edge e) const {
        const auto half = mesh.halfedge_handle(e, 0);
        return {mesh.from_vertex_handle(half), mesh.to_vertex_handle(half)};
    }
    template <class F> void edge_faces(Edge e, F f) const {
        for (int side : {0, 1}) {
            const Face face = mesh.face_handle(mesh.halfedge_handle(e, side));
            if (face.is_valid()) f(face);
        }
    }
    template <class F> void face_vertices(Face x, F f) const { for (auto v : mesh.fv_range(x)) f(Vertex(v)); }
    template <class F> void face_edges(Face x, F f) const { for (auto e : mesh.fe_range(x)) f(Edge(e)); }
    template <class F> void face_faces(Face x, F f) const { for (auto y : mesh.ff_range(x)) f(Face(y)); }
    Vector position(Vertex v) const {
        const auto& p = mesh.point(v);
        return {p[0], p[1], p[2]};
    }
    void set_position(Vertex v, Vector p) { mesh.set_point(v, {p.x, p.y, p.z}); }
};

int main(int argc, char** argv) { return column::serve<Adapter>(argc, argv); }
