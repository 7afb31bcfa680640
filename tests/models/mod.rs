//! Models in the macro language, one file each. The suite `physics` tests every one against an independent truth; the
//! suite `laws` tests what holds for all of them.

pub mod contact;
pub mod dc_motor;
pub mod double_pendulum;
pub mod drives;
pub mod free_body;
pub mod hacksaw_with_motor;
pub mod hydraulic_cylinder;
pub mod joints;
pub mod mass_spring_damper;
pub mod modulated;
pub mod nonlinear;
pub mod orbit;
pub mod orifice;
pub mod permuted;
pub mod rlc_circuit;
pub mod slider_crank;
pub mod sources;
pub mod spinning_top;

/// Hands the list of the hacksaw's models to the macro `$then`: name of a test, type and parameters.
#[macro_export]
macro_rules! each_scene {
    ($then:ident) => {
        $then! {
            literal: Hacksaw (HacksawParameters);
            paper: Paper (PaperParameters);
            motion: Motion (MotionParameters);
            full: Full (FullParameters);
            angles: Angles (AnglesParameters);
            rigid: Rigid (RigidParameters);
            free_run: FreeRun (FreeRunParameters);
        }
    };
}

/// Hands the list of all example models to the macro `$then`: name of a test, module and type, parameters and inputs.
#[macro_export]
macro_rules! each_example {
    ($then:ident) => {
        $then! {
            mass_spring_damper: mass_spring_damper MassSpringDamper (MassSpringDamperParameters, MassSpringDamperInputs { force });
            rlc_circuit: rlc_circuit RlcCircuit (RlcCircuitParameters, RlcCircuitInputs { voltage });
            dc_motor: dc_motor DcMotor (DcMotorParameters, DcMotorInputs { voltage });
            hydraulic_cylinder: hydraulic_cylinder HydraulicCylinder (HydraulicCylinderParameters, HydraulicCylinderInputs { pump_flow });
            orifice: orifice Orifice (OrificeParameters);
            slider_crank: slider_crank SliderCrank (SliderCrankParameters);
            double_pendulum: double_pendulum DoublePendulum (DoublePendulumParameters);
            spinning_top: spinning_top SpinningTop (SpinningTopParameters);
            hacksaw_with_motor: hacksaw_with_motor HacksawWithMotor (HacksawWithMotorParameters, HacksawWithMotorInputs { voltage });
            charged_capacitor: sources ChargedCapacitor (ChargedCapacitorParameters);
            stiffness_and_compliance: sources StiffnessAndCompliance (StiffnessAndComplianceParameters);
            modulated_gyrator: modulated ModulatedGyrator (ModulatedGyratorParameters);
            modulated_lever: modulated ModulatedLever (ModulatedLeverParameters);
            modulated_resistance: modulated ModulatedResistance (ModulatedResistanceParameters);
            modulated_sources: modulated ModulatedSources (ModulatedSourcesParameters);
            duffing: nonlinear Duffing (DuffingParameters);
            pendulum: nonlinear Pendulum (PendulumParameters);
            relativistic_mass: nonlinear RelativisticMass (RelativisticMassParameters);
            unequal_damper: nonlinear UnequalDamper (UnequalDamperParameters);
            rectifier: nonlinear Rectifier (RectifierParameters);
            free_body: free_body FreeBody (FreeBodyParameters);
            orbit: orbit Orbit (OrbitParameters);
            drives: drives Drives (DrivesParameters);
            pushed_plate: drives PushedPlate (PushedPlateParameters);
            sliding_block: contact SlidingBlock (SlidingBlockParameters);
            plate_on_revolute: joints PlateOnRevolute (PlateOnRevoluteParameters);
            plate_on_revolute_inertial: joints PlateOnRevoluteInertial (PlateOnRevoluteInertialParameters);
            plate_on_revolute_per_axis: joints PlateOnRevolutePerAxis (PlateOnRevolutePerAxisParameters);
            plate_on_prismatic: joints PlateOnPrismatic (PlateOnPrismaticParameters);
            plate_on_prismatic_inertial: joints PlateOnPrismaticInertial (PlateOnPrismaticInertialParameters);
            plate_on_spherical: joints PlateOnSpherical (PlateOnSphericalParameters);
            plate_on_cylindrical: joints PlateOnCylindrical (PlateOnCylindricalParameters);
            plate_on_universal: joints PlateOnUniversal (PlateOnUniversalParameters);
            plate_on_universal_zx: joints PlateOnUniversalZx (PlateOnUniversalZxParameters);
            plate_on_fixed: joints PlateOnFixed (PlateOnFixedParameters);
            plate_on_fixed_inertial: joints PlateOnFixedInertial (PlateOnFixedInertialParameters);
            forward: permuted Forward (ForwardParameters);
            chain: permuted Chain (ChainParameters);
            backward: permuted Backward (BackwardParameters);
            chain_backward: permuted ChainBackward (ChainBackwardParameters);
        }
    };
}
