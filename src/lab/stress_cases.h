// The stress cases. stress_cases.cc lists them.
#ifndef SHEAF_LAB_STRESS_CASES_H_
#define SHEAF_LAB_STRESS_CASES_H_

#include "src/lab/stress.h"

namespace sheaf::stress {

// leak_cases.cc
void FarLeaks(Report& report);
void OriginLeaks(Report& report);
void GridLeaks(Report& report);
void Diagonal(Report& report);
void SlantedEdge(Report& report);
void HalfSphere(Report& report);
void PerturbedSpheres(Report& report);
void Slivers(Report& report);
void Fan(Report& report);
void ScaledWorld(Report& report);
void Horizon(Report& report);

// ray_start_cases.cc
void SelfHits(Report& report);
void Acne(Report& report);

// sphere_cases.cc
void NearlyEqualSpheres(Report& report);
void NearTangent(Report& report);
void GroundSphere(Report& report);
void OnSphere(Report& report);
void FromCentre(Report& report);
void BadRadius(Report& report);

// disk_cases.cc
void DiskRims(Report& report);
void GrazingDisks(Report& report);
void InDiskPlane(Report& report);
void DiskSources(Report& report);
void DiskSizes(Report& report);
void CoplanarDisks(Report& report);

// number_cases.cc
void PowersOfTwo(Report& report);
void MinusZero(Report& report);
void BadDirections(Report& report);
void BadNumbers(Report& report);
void BoxFace(Report& report);
void Denormals(Report& report);
void Intervals(Report& report);
void LongDirections(Report& report);

// degenerate_cases.cc
void Collinear(Report& report);
void ZeroArea(Report& report);
void CoplanarDuplicates(Report& report);
void InPlane(Report& report);
void UlpApart(Report& report);

// tree_cases.cc
void Duplicates(Report& report);
void ManyInOnePlace(Report& report);
void LinearMemory(Report& report);
void RandomScenes(Report& report);

// refraction_cases.cc
void CriticalAngle(Report& report);
void ExtremeIors(Report& report);

// glass_cases.cc
void NestedGlass(Report& report);
void ClearGlass(Report& report);
void ExtremeGlass(Report& report);
void HallOfMirrors(Report& report);
void MirrorSeries(Report& report);

// light_cases.cc
void LightsInTheWay(Report& report);
void Shininess(Report& report);
void ShadowTerminator(Report& report);
void OverbrightSurfaces(Report& report);
void ManyLights(Report& report);
void ScaledPictures(Report& report);

// place_cases.cc
void MovedScenes(Report& report);
void UnitsOfLength(Report& report);
void HugeGround(Report& report);
void ThinWalls(Report& report);
void SmoothTerminator(Report& report);

// geometry_cases.cc
void AnySize(Report& report);
void GiantsAndOddRays(Report& report);
void GoingOn(Report& report);

// watertight_cases.cc
void NoMiss(Report& report);
void SingleHit(Report& report);

// description_cases.cc
void BadMaterials(Report& report);
void PngTransfers(Report& report);
void OddSizes(Report& report);
void Nothing(Report& report);
void Transforms(Report& report);
void MirroredWinding(Report& report);
void FieldsOfView(Report& report);

}  // namespace sheaf::stress

#endif  // SHEAF_LAB_STRESS_CASES_H_
