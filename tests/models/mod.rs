//! Models in the macro language, one file each. The suite `physics` tests every one against an independent truth; the
//! suite `laws` tests what holds for all of them.

pub mod brakes;
pub mod drives;
pub mod hacksaw_with_motor;
pub mod joints;
pub mod long;
pub mod loops;
pub mod mechanisms;
pub mod modulated;
pub mod nonlinear;
pub mod permuted;
pub mod sources;

// The gallery: programs of the workbench, whose `main` nobody calls here.
#[path = "../../bg-model/workbench/examples/contact.rs"]
#[allow(dead_code)]
pub mod contact;
#[path = "../../bg-model/workbench/examples/dc_motor.rs"]
#[allow(dead_code)]
pub mod dc_motor;
#[path = "../../bg-model/workbench/examples/double_pendulum.rs"]
#[allow(dead_code)]
pub mod double_pendulum;
#[path = "../../bg-model/workbench/examples/free_body.rs"]
#[allow(dead_code)]
pub mod free_body;
#[path = "../../bg-model/workbench/examples/gearbox.rs"]
#[allow(dead_code)]
pub mod gearbox;
#[path = "../../bg-model/workbench/examples/hydraulic_cylinder.rs"]
#[allow(dead_code)]
pub mod hydraulic_cylinder;
#[path = "../../bg-model/workbench/examples/mass_spring_damper.rs"]
#[allow(dead_code)]
pub mod mass_spring_damper;
#[path = "../../bg-model/workbench/examples/orbit.rs"]
#[allow(dead_code)]
pub mod orbit;
#[path = "../../bg-model/workbench/examples/orifice.rs"]
#[allow(dead_code)]
pub mod orifice;
#[path = "../../bg-model/workbench/examples/rlc_circuit.rs"]
#[allow(dead_code)]
pub mod rlc_circuit;
#[path = "../../bg-model/workbench/examples/slider_crank.rs"]
#[allow(dead_code)]
pub mod slider_crank;
#[path = "../../bg-model/workbench/examples/spinning_top.rs"]
#[allow(dead_code)]
pub mod spinning_top;
#[path = "../../bg-model/workbench/examples/stick_slip.rs"]
#[allow(dead_code)]
pub mod stick_slip;
#[path = "../../bg-model/workbench/examples/train.rs"]
#[allow(dead_code)]
pub mod train;

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
            mass_spring_damper: mass_spring_damper MassSpringDamper (MassSpringDamperParameters,
                MassSpringDamperInputs { force });
            rlc_circuit: rlc_circuit RlcCircuit (RlcCircuitParameters, RlcCircuitInputs { voltage });
            dc_motor: dc_motor DcMotor (DcMotorParameters, DcMotorInputs { voltage });
            gearbox: gearbox Gearbox (GearboxParameters, GearboxInputs { voltage });
            bridge: loops Bridge (BridgeParameters);
            lever: loops Lever (LeverParameters);
            clipped: loops Clipped (ClippedParameters);
            charger: loops Charger (ChargerParameters);
            manifold: loops Manifold (ManifoldParameters);
            hydraulic_cylinder: hydraulic_cylinder HydraulicCylinder (HydraulicCylinderParameters,
                HydraulicCylinderInputs { pump_flow });
            orifice: orifice Orifice (OrificeParameters);
            slider_crank: slider_crank SliderCrank (SliderCrankParameters);
            double_pendulum: double_pendulum DoublePendulum (DoublePendulumParameters);
            spinning_top: spinning_top SpinningTop (SpinningTopParameters);
            hacksaw_with_motor: hacksaw_with_motor HacksawWithMotor (HacksawWithMotorParameters,
                HacksawWithMotorInputs { voltage });
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
            stick_slip: stick_slip StickSlip (StickSlipParameters);
            journal: brakes Journal (JournalParameters);
            carriage: brakes Carriage (CarriageParameters);
            train: train Train (TrainParameters);
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
