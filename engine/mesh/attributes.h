// What faces carry besides their vertices, kept while faces are copied, divided and dropped. The only code that knows
// how corner channels are laid out.
#pragma once
#include <array>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// `mesh` gets the channels of `pattern`, same names in the same order: its own where name and component count agree,
// zeros for the rest. Needed before the functions below append from `pattern` to `mesh`.
void match_channels(const SurfaceMesh& pattern, SurfaceMesh& mesh);

// Appends the channel values of one face to `to`, whose channels match. The face's triangle and columns are the
// caller's.
void copy_corners(const SurfaceMesh& from, std::uint32_t face, SurfaceMesh& to);

// The same for a triangle with corners `at` (metres) in the plane of `face`: linear inside the face, continued linearly
// outside. A face without area gives the values of its nearest corner.
void interpolate_corners(const SurfaceMesh& from, std::uint32_t face, const std::array<Vec3, 3>& at, SurfaceMesh& to);

// The same for one corner at p; three of these make a face.
void append_corner(const SurfaceMesh& from, std::uint32_t face, const Vec3& p, SurfaceMesh& to);

// Appends triangle `t` (vertices of `to`) with the columns and channel values of `face`.
void append_face(const SurfaceMesh& from, std::uint32_t face, const Triangle& t, SurfaceMesh& to);

// Faces first .. last - 1 with the vertex numbers they have in `from`.
void append_faces(const SurfaceMesh& from, std::uint32_t first, std::uint32_t last, SurfaceMesh& to);

// Keeps the faces with keep[t], in order; vertices stay.
void keep_faces(SurfaceMesh& mesh, const std::vector<bool>& keep);

// Overwrites what face `slot` of `to` carries with what `face` carries: columns and, channels matching, corner values.
void overwrite_face(const SurfaceMesh& from, std::uint32_t face, std::uint32_t slot, SurfaceMesh& to);

// Turns a face over: corners 1 and 2 swap, with their values.
void turn_face(SurfaceMesh& mesh, std::size_t face);

// Weights of the corners at p, which sum to 1: p's foot in the face's plane, linear beyond the edges.
std::array<Real, 3> corner_weights(const SurfaceMesh& mesh, std::uint32_t face, const Vec3& p);

// "" when every column and channel has the length the triangles ask for, else what is wrong.
std::string check_attributes(const SurfaceMesh& mesh);

}  // namespace sherd
