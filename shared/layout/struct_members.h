/* Every struct that crosses between host and device, and every member of it, in order: STRUCT(type), then MEMBER(type,
 * member) for each of its members. tests/math/test_platform_bits.c checks that it is complete. */
#ifndef TWINLIGHT_LAYOUT_STRUCT_MEMBERS_H
#define TWINLIGHT_LAYOUT_STRUCT_MEMBERS_H

#define STRUCT_MEMBERS(STRUCT, MEMBER)                                                                                 \
    STRUCT(Vec2)                                                                                                       \
    MEMBER(Vec2, x)                                                                                                    \
    MEMBER(Vec2, y)                                                                                                    \
    STRUCT(Vec3)                                                                                                       \
    MEMBER(Vec3, x)                                                                                                    \
    MEMBER(Vec3, y)                                                                                                    \
    MEMBER(Vec3, z)                                                                                                    \
    STRUCT(Frame)                                                                                                      \
    MEMBER(Frame, t)                                                                                                   \
    MEMBER(Frame, b)                                                                                                   \
    MEMBER(Frame, n)                                                                                                   \
    STRUCT(Affine)                                                                                                     \
    MEMBER(Affine, m)                                                                                                  \
    STRUCT(Primitive)                                                                                                  \
    MEMBER(Primitive, a)                                                                                               \
    MEMBER(Primitive, b)                                                                                               \
    MEMBER(Primitive, c)                                                                                               \
    MEMBER(Primitive, shape_and_kind)                                                                                  \
    STRUCT(Shape)                                                                                                      \
    MEMBER(Shape, material)                                                                                            \
    MEMBER(Shape, alpha)                                                                                               \
    MEMBER(Shape, first_light)                                                                                         \
    MEMBER(Shape, first_primitive)                                                                                     \
    MEMBER(Shape, first_vertex)                                                                                        \
    MEMBER(Shape, first_normal)                                                                                        \
    MEMBER(Shape, first_uv)                                                                                            \
    MEMBER(Shape, flags)                                                                                               \
    STRUCT(Patch)                                                                                                      \
    MEMBER(Patch, v)                                                                                                   \
    STRUCT(Quadric)                                                                                                    \
    MEMBER(Quadric, world_from_object)                                                                                 \
    MEMBER(Quadric, object_from_world)                                                                                 \
    MEMBER(Quadric, radius)                                                                                            \
    MEMBER(Quadric, inner_radius)                                                                                      \
    MEMBER(Quadric, z_min)                                                                                             \
    MEMBER(Quadric, z_max)                                                                                             \
    MEMBER(Quadric, phi_max)                                                                                           \
    MEMBER(Quadric, whole)                                                                                             \
    MEMBER(Quadric, center)                                                                                            \
    MEMBER(Quadric, world_radius)                                                                                      \
    STRUCT(Curve)                                                                                                      \
    MEMBER(Curve, p)                                                                                                   \
    MEMBER(Curve, width)                                                                                               \
    STRUCT(Object)                                                                                                     \
    MEMBER(Object, first_primitive)                                                                                    \
    MEMBER(Object, primitive_count)                                                                                    \
    STRUCT(Instance)                                                                                                   \
    MEMBER(Instance, world_from_object)                                                                                \
    MEMBER(Instance, object_from_world)                                                                                \
    MEMBER(Instance, object)                                                                                           \
    STRUCT(TextureOp)                                                                                                  \
    MEMBER(TextureOp, code)                                                                                            \
    MEMBER(TextureOp, index)                                                                                           \
    MEMBER(TextureOp, mapping)                                                                                         \
    MEMBER(TextureOp, invert)                                                                                          \
    MEMBER(TextureOp, value)                                                                                           \
    MEMBER(TextureOp, scale)                                                                                           \
    MEMBER(TextureOp, uv_map)                                                                                          \
    MEMBER(TextureOp, texture_from_world)                                                                              \
    STRUCT(TextureImage)                                                                                               \
    MEMBER(TextureImage, width)                                                                                        \
    MEMBER(TextureImage, height)                                                                                       \
    MEMBER(TextureImage, channels)                                                                                     \
    MEMBER(TextureImage, format)                                                                                       \
    MEMBER(TextureImage, first_word)                                                                                   \
    MEMBER(TextureImage, wrap)                                                                                         \
    MEMBER(TextureImage, filter)                                                                                       \
    MEMBER(TextureImage, lut)                                                                                          \
    STRUCT(ColorParam)                                                                                                 \
    MEMBER(ColorParam, value)                                                                                          \
    MEMBER(ColorParam, program)                                                                                        \
    STRUCT(FloatParam)                                                                                                 \
    MEMBER(FloatParam, value)                                                                                          \
    MEMBER(FloatParam, program)                                                                                        \
    STRUCT(Material)                                                                                                   \
    MEMBER(Material, kind)                                                                                             \
    MEMBER(Material, flags)                                                                                            \
    MEMBER(Material, color0)                                                                                           \
    MEMBER(Material, color1)                                                                                           \
    MEMBER(Material, roughness_u)                                                                                      \
    MEMBER(Material, roughness_v)                                                                                      \
    MEMBER(Material, amount)                                                                                           \
    MEMBER(Material, displacement)                                                                                     \
    MEMBER(Material, base_u)                                                                                           \
    MEMBER(Material, base_v)                                                                                           \
    MEMBER(Material, eta)                                                                                              \
    MEMBER(Material, scale)                                                                                            \
    MEMBER(Material, normal_map)                                                                                       \
    MEMBER(Material, mix_a)                                                                                            \
    MEMBER(Material, mix_b)                                                                                            \
    MEMBER(Material, coat_table)                                                                                       \
    STRUCT(Light)                                                                                                      \
    MEMBER(Light, flags)                                                                                               \
    MEMBER(Light, primitive)                                                                                           \
    MEMBER(Light, emission)                                                                                            \
    MEMBER(Light, area)                                                                                                \
    MEMBER(Light, select_pdf)                                                                                          \
    STRUCT(LightDetail)                                                                                                \
    MEMBER(LightDetail, image)                                                                                         \
    MEMBER(LightDetail, distribution)                                                                                  \
    MEMBER(LightDetail, portal)                                                                                        \
    MEMBER(LightDetail, medium)                                                                                        \
    MEMBER(LightDetail, position)                                                                                      \
    MEMBER(LightDetail, direction)                                                                                     \
    MEMBER(LightDetail, cos_total)                                                                                     \
    MEMBER(LightDetail, cos_falloff)                                                                                   \
    MEMBER(LightDetail, world_from_light)                                                                              \
    MEMBER(LightDetail, light_from_world)                                                                              \
    STRUCT(Distribution2D)                                                                                             \
    MEMBER(Distribution2D, width)                                                                                      \
    MEMBER(Distribution2D, height)                                                                                     \
    MEMBER(Distribution2D, first_marginal)                                                                             \
    MEMBER(Distribution2D, first_conditional)                                                                          \
    STRUCT(Portal)                                                                                                     \
    MEMBER(Portal, corner)                                                                                             \
    MEMBER(Portal, width)                                                                                              \
    MEMBER(Portal, height)                                                                                             \
    MEMBER(Portal, axes)                                                                                               \
    MEMBER(Portal, columns)                                                                                            \
    MEMBER(Portal, rows)                                                                                               \
    MEMBER(Portal, sums)                                                                                               \
    STRUCT(AliasBucket)                                                                                                \
    MEMBER(AliasBucket, q)                                                                                             \
    MEMBER(AliasBucket, alias)                                                                                         \
    STRUCT(LightNode)                                                                                                  \
    MEMBER(LightNode, left)                                                                                            \
    MEMBER(LightNode, xy)                                                                                              \
    MEMBER(LightNode, z_size)                                                                                          \
    MEMBER(LightNode, axes)                                                                                            \
    STRUCT(LightTree)                                                                                                  \
    MEMBER(LightTree, leaves)                                                                                          \
    MEMBER(LightTree, flags)                                                                                           \
    MEMBER(LightTree, cone)                                                                                            \
    MEMBER(LightTree, axis)                                                                                            \
    MEMBER(LightTree, center)                                                                                          \
    MEMBER(LightTree, radius)                                                                                          \
    MEMBER(LightTree, lamps)                                                                                           \
    MEMBER(LightTree, far)                                                                                             \
    STRUCT(Aim)                                                                                                        \
    MEMBER(Aim, center)                                                                                                \
    MEMBER(Aim, radius)                                                                                                \
    STRUCT(Camera)                                                                                                     \
    MEMBER(Camera, kind)                                                                                               \
    MEMBER(Camera, lens_radius)                                                                                        \
    MEMBER(Camera, focal_distance)                                                                                     \
    MEMBER(Camera, screen)                                                                                             \
    MEMBER(Camera, world_from_camera)                                                                                  \
    MEMBER(Camera, camera_from_world)                                                                                  \
    MEMBER(Camera, medium)                                                                                             \
    STRUCT(Medium)                                                                                                     \
    MEMBER(Medium, extinction)                                                                                         \
    MEMBER(Medium, scattering)                                                                                         \
    MEMBER(Medium, emission)                                                                                           \
    MEMBER(Medium, g)                                                                                                  \
    MEMBER(Medium, grid)                                                                                               \
    STRUCT(MediumGrid)                                                                                                 \
    MEMBER(MediumGrid, grid_from_world)                                                                                \
    MEMBER(MediumGrid, size_x)                                                                                         \
    MEMBER(MediumGrid, size_y)                                                                                         \
    MEMBER(MediumGrid, size_z)                                                                                         \
    MEMBER(MediumGrid, low)                                                                                            \
    MEMBER(MediumGrid, words)                                                                                          \
    MEMBER(MediumGrid, bricks)                                                                                         \
    MEMBER(MediumGrid, emission)                                                                                       \
    MEMBER(MediumGrid, aligned)                                                                                        \
    MEMBER(MediumGrid, table)                                                                                          \
    MEMBER(MediumGrid, kelvin_scale)                                                                                   \
    MEMBER(MediumGrid, kelvin_offset)                                                                                  \
    STRUCT(PixelFilter)                                                                                                \
    MEMBER(PixelFilter, kind)                                                                                          \
    MEMBER(PixelFilter, radius_x)                                                                                      \
    MEMBER(PixelFilter, radius_y)                                                                                      \
    MEMBER(PixelFilter, table_x)                                                                                       \
    MEMBER(PixelFilter, table_y)                                                                                       \
    MEMBER(PixelFilter, weight)                                                                                        \
    STRUCT(SceneLayout)                                                                                                \
    MEMBER(SceneLayout, positions)                                                                                     \
    MEMBER(SceneLayout, normals)                                                                                       \
    MEMBER(SceneLayout, uvs)                                                                                           \
    MEMBER(SceneLayout, primitives)                                                                                    \
    MEMBER(SceneLayout, shapes)                                                                                        \
    MEMBER(SceneLayout, patches)                                                                                       \
    MEMBER(SceneLayout, quadrics)                                                                                      \
    MEMBER(SceneLayout, curves)                                                                                        \
    MEMBER(SceneLayout, objects)                                                                                       \
    MEMBER(SceneLayout, instances)                                                                                     \
    MEMBER(SceneLayout, materials)                                                                                     \
    MEMBER(SceneLayout, texture_ops)                                                                                   \
    MEMBER(SceneLayout, images)                                                                                        \
    MEMBER(SceneLayout, lights)                                                                                        \
    MEMBER(SceneLayout, light_details)                                                                                 \
    MEMBER(SceneLayout, light_alias)                                                                                   \
    MEMBER(SceneLayout, light_tree)                                                                                    \
    MEMBER(SceneLayout, light_nodes)                                                                                   \
    MEMBER(SceneLayout, light_leaves)                                                                                  \
    MEMBER(SceneLayout, infinite_lights)                                                                               \
    MEMBER(SceneLayout, portals)                                                                                       \
    MEMBER(SceneLayout, aims)                                                                                          \
    MEMBER(SceneLayout, distributions2d)                                                                               \
    MEMBER(SceneLayout, lookup)                                                                                        \
    MEMBER(SceneLayout, media)                                                                                         \
    MEMBER(SceneLayout, grids)                                                                                         \
    STRUCT(SceneParams)                                                                                                \
    MEMBER(SceneParams, layout)                                                                                        \
    MEMBER(SceneParams, features)                                                                                      \
    MEMBER(SceneParams, light_count)                                                                                   \
    MEMBER(SceneParams, infinite_light_count)                                                                          \
    MEMBER(SceneParams, aim_count)                                                                                     \
    MEMBER(SceneParams, guide_count)                                                                                   \
    MEMBER(SceneParams, world_center)                                                                                  \
    MEMBER(SceneParams, world_radius)                                                                                  \
    MEMBER(SceneParams, ray_reach)                                                                                     \
    STRUCT(FilmParams)                                                                                                 \
    MEMBER(FilmParams, width)                                                                                          \
    MEMBER(FilmParams, height)                                                                                         \
    MEMBER(FilmParams, crop_x0)                                                                                        \
    MEMBER(FilmParams, crop_y0)                                                                                        \
    MEMBER(FilmParams, crop_x1)                                                                                        \
    MEMBER(FilmParams, crop_y1)                                                                                        \
    MEMBER(FilmParams, filter)                                                                                         \
    MEMBER(FilmParams, exponent)                                                                                       \
    MEMBER(FilmParams, split_depths)                                                                                   \
    MEMBER(FilmParams, reconstruction)                                                                                 \
    STRUCT(PhotonParams)                                                                                               \
    MEMBER(PhotonParams, count)                                                                                        \
    MEMBER(PhotonParams, everywhere)                                                                                   \
    MEMBER(PhotonParams, first)                                                                                        \
    MEMBER(PhotonParams, level)                                                                                        \
    MEMBER(PhotonParams, directory_level)                                                                              \
    MEMBER(PhotonParams, directory)                                                                                    \
    MEMBER(PhotonParams, origin)                                                                                       \
    MEMBER(PhotonParams, cells_per_unit)                                                                               \
    MEMBER(PhotonParams, point_radius)                                                                                 \
    MEMBER(PhotonParams, distant_sine)                                                                                 \
    STRUCT(Opening)                                                                                                    \
    MEMBER(Opening, light)                                                                                             \
    MEMBER(Opening, axis)                                                                                              \
    MEMBER(Opening, at)                                                                                                \
    MEMBER(Opening, u_low)                                                                                             \
    MEMBER(Opening, v_low)                                                                                             \
    MEMBER(Opening, u_high)                                                                                            \
    MEMBER(Opening, v_high)                                                                                            \
    MEMBER(Opening, side)                                                                                              \
    MEMBER(Opening, share)                                                                                             \
    STRUCT(OpeningParams)                                                                                              \
    MEMBER(OpeningParams, count)                                                                                       \
    MEMBER(OpeningParams, frame)                                                                                       \
    MEMBER(OpeningParams, each)                                                                                        \
    MEMBER(OpeningParams, light_count)                                                                                 \
    MEMBER(OpeningParams, lights)                                                                                      \
    MEMBER(OpeningParams, light_shares)                                                                                \
    MEMBER(OpeningParams, light_pdfs)                                                                                  \
    STRUCT(PathParams)                                                                                                 \
    MEMBER(PathParams, max_depth)                                                                                      \
    MEMBER(PathParams, min_depth)                                                                                      \
    MEMBER(PathParams, roulette_depth)                                                                                 \
    MEMBER(PathParams, roulette_scale)                                                                                 \
    MEMBER(PathParams, strategies)                                                                                     \
    MEMBER(PathParams, mis_exponent)                                                                                   \
    MEMBER(PathParams, only_s)                                                                                         \
    MEMBER(PathParams, only_t)                                                                                         \
    MEMBER(PathParams, unweighted)                                                                                     \
    MEMBER(PathParams, sobol)                                                                                          \
    STRUCT(PartitionParams)                                                                                            \
    MEMBER(PartitionParams, split_direct)                                                                              \
    MEMBER(PartitionParams, own_more)                                                                                  \
    MEMBER(PartitionParams, clamp_threshold)                                                                           \
    STRUCT(PoolParams)                                                                                                 \
    MEMBER(PoolParams, enabled)                                                                                        \
    MEMBER(PoolParams, items)                                                                                          \
    MEMBER(PoolParams, lights)                                                                                         \
    MEMBER(PoolParams, lights_first)                                                                                   \
    MEMBER(PoolParams, lights_weight)                                                                                  \
    MEMBER(PoolParams, visits)                                                                                         \
    STRUCT(ChainParams)                                                                                                \
    MEMBER(ChainParams, mutations)                                                                                     \
    MEMBER(ChainParams, shifts)                                                                                        \
    MEMBER(ChainParams, large_step)                                                                                    \
    MEMBER(ChainParams, keep)                                                                                          \
    MEMBER(ChainParams, brightness)                                                                                    \
    STRUCT(PassParams)                                                                                                 \
    MEMBER(PassParams, seed_low)                                                                                       \
    MEMBER(PassParams, seed_high)                                                                                      \
    MEMBER(PassParams, aovs)                                                                                           \
    MEMBER(PassParams, sample_index)                                                                                   \
    MEMBER(PassParams, pixel_stride)                                                                                   \
    MEMBER(PassParams, pixel_first)                                                                                    \
    MEMBER(PassParams, first_item)                                                                                     \
    MEMBER(PassParams, item_count)                                                                                     \
    MEMBER(PassParams, stride)                                                                                         \
    MEMBER(PassParams, data_first)                                                                                     \
    MEMBER(PassParams, data_stride)                                                                                    \
    STRUCT(FrameParams)                                                                                                \
    MEMBER(FrameParams, scene)                                                                                         \
    MEMBER(FrameParams, camera)                                                                                        \
    MEMBER(FrameParams, film)                                                                                          \
    MEMBER(FrameParams, path)                                                                                          \
    MEMBER(FrameParams, photons)                                                                                       \
    MEMBER(FrameParams, openings)                                                                                      \
    MEMBER(FrameParams, partition)                                                                                     \
    MEMBER(FrameParams, pool)                                                                                          \
    MEMBER(FrameParams, chains)                                                                                        \
    MEMBER(FrameParams, pass)                                                                                          \
    STRUCT(Guide)                                                                                                      \
    MEMBER(Guide, lights)                                                                                              \
    MEMBER(Guide, lights_near)                                                                                         \
    MEMBER(Guide, lights_power)                                                                                        \
    MEMBER(Guide, importance)                                                                                          \
    MEMBER(Guide, visits)

#endif
